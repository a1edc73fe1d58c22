#include "client/commands/tree_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <span>
#include <utility>

#include "client/commands/shared_options.h"
#include "client/output_file.h"
#include "client/render/skeleton_view.h"
#include "client/render/surface_view.h"
#include "client/scene_files.h"
#include "client/tree_rows.h"
#include "core/codec/image_codec.h"
#include "core/codec/svg.h"
#include "core/codec/swc.h"
#include "core/codec/tree_csv.h"

namespace terrane::client {
namespace {

constexpr char kInk[] = "#3d3024";
constexpr Rgb kInkColour{0.24, 0.19, 0.14};

absl::Status WriteBytes(const std::string& path, const std::string& bytes,
                        TreeSummary* summary) {
  summary->add_files(path);
  return WriteFile(path, std::as_bytes(std::span(bytes)));
}

absl::Status WritePicture(const std::string& path, const Picture& picture,
                          TreeSummary* summary) {
  const absl::StatusOr<core::EncodedImage> bytes = core::EncodePng(picture);
  if (!bytes.ok()) return bytes.status();
  summary->add_files(path);
  return WriteFile(path, std::as_bytes(std::span(*bytes)));
}

void Announce(const v1::TreeHeader& header, TreeSummary* summary) {
  summary->set_trees(1);
  summary->set_recipe_hash(header.recipe_hash());
  summary->set_revision(header.revision());
}

// What the scene's objects hold, each mesh once.
void CountScene(const core::Scene& scene, TreeSummary* summary) {
  for (const core::SceneObject& object : scene.objects) {
    const core::Mesh& mesh = *object.mesh;
    summary->set_vertices(summary->vertices() +
                          static_cast<double>(mesh.positions.size()));
    summary->set_triangles(summary->triangles() +
                           static_cast<double>(mesh.indices.size() / 3));
  }
}

// What made the file, for asset.extras.
std::string OriginOf(const v1::TreeHeader& header) {
  v1::TreeHeader origin;
  *origin.mutable_recipe() = header.recipe();
  origin.set_recipe_hash(header.recipe_hash());
  origin.set_revision(header.revision());
  return JsonLine(origin);
}

core::GlbOptions GlbOptionsOf(const TreeFileOptions& options,
                              const v1::TreeHeader& header) {
  return {.instancing = options.instancing,
          .metres_per_unit = options.metres_per_unit,
          .extras = OriginOf(header)};
}

// The rows of a tree without its last `level` generations. The rows of a lower
// depth are the first rows of a higher one, so fewer are asked for.
absl::StatusOr<StreamedTree> StreamRows(const ChosenTree& tree, int level,
                                        ProgressMode progress,
                                        TreeBackend* backend,
                                        std::stop_token stop) {
  v1::TreeRecipe recipe = tree.recipe;
  if (level > 0) {
    v1::EstimateTreeRequest ask;
    *ask.mutable_tree()->mutable_recipe() = recipe;
    const auto estimate = backend->EstimateTree(ask, stop);
    if (!estimate.ok()) return estimate.status();
    const absl::StatusOr<int> last = LastGeneration(level, *estimate);
    if (!last.ok()) return last.status();
    recipe.set_depth(*last);
  }
  return StreamWholeTree(recipe, progress, backend, std::move(stop));
}

bool IsRowFile(TreeFormat format, const ChosenTree& tree,
               const TreeFileOptions& options) {
  switch (format) {
    case TreeFormat::kSvg:
    case TreeFormat::kSwc:
    case TreeFormat::kCsv:
      return true;
    case TreeFormat::kPng:
      return tree.recipe.dimensions() != 3 &&
             !(options.model.leaves && tree.recipe.has_leaves());
    default:
      return false;
  }
}

absl::Status WriteRows(TreeFormat format, const ChosenTree& tree,
                       const TreeFileOptions& options, TreeBackend* backend,
                       std::stop_token stop, TreeSummary* summary) {
  absl::StatusOr<StreamedTree> streamed =
      StreamRows(tree, options.levels.front(), options.model.progress, backend,
                 std::move(stop));
  if (!streamed.ok()) return streamed.status();
  core::SegmentBlock& rows = streamed->rows;
  Announce(streamed->header, summary);
  summary->set_segments(static_cast<double>(rows.rows()));
  if (format == TreeFormat::kSwc) {
    return WriteBytes(options.out, core::EncodeSwc(rows), summary);
  }
  if (format == TreeFormat::kCsv) {
    return WriteBytes(options.out, core::EncodeTreeCsv(rows), summary);
  }
  if (tree.recipe.form() == v1::TREE_FORM_CANTOR) SpreadGenerations(&rows);
  if (format == TreeFormat::kSvg) {
    return WriteBytes(options.out, core::EncodeTreeSvg(rows, kInk), summary);
  }
  return WritePicture(options.out,
                      DrawSkeleton(rows, options.picture_size, kInkColour),
                      summary);
}

Picture DrawScene(const core::Scene& scene, const ChosenTree& tree, int size) {
  SurfaceViewOptions view;
  view.width = view.most_height = size;
  const bool is_flat = tree.recipe.dimensions() != 3;
  view.turn_deg = is_flat ? 0 : 20;
  view.tilt_deg = is_flat ? 0 : 8;
  view.light = {-0.5, -0.6, 0.6244997998398398};
  return RenderSurface(MergedMesh(scene), {}, view);
}

absl::Status WriteModels(TreeFormat format, const ChosenTree& tree,
                         const TreeFileOptions& options, TreeBackend* backend,
                         std::stop_token stop, TreeSummary* summary) {
  const absl::StatusOr<TreeLook> look = TreeLook::Create(tree.view);
  if (!look.ok()) return look.status();
  std::vector<TreeModel> models;
  std::vector<core::Scene> scenes;
  // Scenes refer to the models.
  models.reserve(options.levels.size());
  for (const int level : options.levels) {
    TreeModelOptions of_level = options.model;
    of_level.level = level;
    absl::StatusOr<TreeModel> model =
        StreamTreeModel(tree.recipe, of_level, backend, stop);
    if (!model.ok()) return model.status();
    models.push_back(std::move(*model));
    scenes.push_back(look->SceneOf(models.back()));
  }
  Announce(models.front().header, summary);
  CountScene(scenes.front(), summary);
  summary->set_leaves(static_cast<double>(models.front().leaves.count()));
  if (format == TreeFormat::kPng) {
    return WritePicture(options.out,
                        DrawScene(scenes.front(), tree, options.picture_size),
                        summary);
  }
  if (format == TreeFormat::kObj) {
    std::vector<std::string> files;
    const absl::Status written =
        WriteScene(options.out, scenes.front(), {}, &files);
    for (const std::string& file : files) summary->add_files(file);
    return written;
  }
  const absl::StatusOr<std::string> glb =
      core::EncodeGlb(scenes, GlbOptionsOf(options, models.front().header));
  if (!glb.ok()) return glb.status();
  return WriteBytes(options.out, *glb, summary);
}

// A text file that grows tree by tree.
class GrowingFile {
 public:
  static absl::StatusOr<GrowingFile> Create(const std::string& path) {
    absl::StatusOr<OutputFile> file = OutputFile::Create(path);
    if (!file.ok()) return file.status();
    return GrowingFile(std::move(*file));
  }

  absl::Status Append(const std::string& text) {
    const absl::Status written =
        file_.WriteAt(size_, std::as_bytes(std::span(text)));
    size_ += static_cast<std::int64_t>(text.size());
    return written;
  }
  absl::Status Commit() { return file_.Commit(); }

 private:
  explicit GrowingFile(OutputFile file) : file_(std::move(file)) {}

  OutputFile file_;
  std::int64_t size_ = 0;
};

template <typename Writer>
absl::Status WriteTable(const ChosenTree& tree, const Forest& forest,
                        const TreeFileOptions& options, TreeBackend* backend,
                        std::stop_token stop, TreeSummary* summary) {
  absl::StatusOr<GrowingFile> file = GrowingFile::Create(options.out);
  if (!file.ok()) return file.status();
  const absl::Status begun = file->Append(Writer::Header());
  if (!begun.ok()) return begun;
  Writer writer;
  const absl::StatusOr<ForestStream> stream = StreamForestTrees(
      forest, tree.recipe, options.model.progress,
      [&](const core::SegmentBlock& rows) {
        return file->Append(writer.Add(rows));
      },
      backend, std::move(stop));
  if (!stream.ok()) return stream.status();
  Announce(stream->header, summary);
  summary->set_trees(static_cast<double>(stream->trees));
  summary->set_segments(static_cast<double>(stream->rows));
  summary->add_files(options.out);
  return file->Commit();
}

absl::Status WriteForestModel(const ChosenTree& tree, const Forest& forest,
                              const TreeFileOptions& options,
                              TreeBackend* backend, std::stop_token stop,
                              TreeSummary* summary) {
  const absl::StatusOr<TreeLook> look = TreeLook::Create(tree.view);
  if (!look.ok()) return look.status();
  TreeModelOptions of_level = options.model;
  of_level.level = options.levels.front();
  const absl::StatusOr<ForestModel> model = ForestModel::Stream(
      forest, tree.recipe, of_level, backend, std::move(stop));
  if (!model.ok()) return model.status();
  const core::Scene scene = model->SceneOf(*look);
  Announce(model->header(), summary);
  summary->set_trees(static_cast<double>(forest.count()));
  summary->set_leaves(static_cast<double>(model->leaves().count()));
  CountScene(scene, summary);
  const absl::StatusOr<std::string> glb =
      core::EncodeGlb(scene, GlbOptionsOf(options, model->header()));
  if (!glb.ok()) return glb.status();
  return WriteBytes(options.out, *glb, summary);
}

absl::Status OneLevel(const TreeFileOptions& options) {
  if (options.levels.size() == 1) return absl::OkStatus();
  return absl::InvalidArgumentError(
      fmt::format("--lod: several levels go into a .glb file of one tree, got "
                  "{} for {}",
                  options.levels.size(), options.out));
}

}  // namespace

absl::StatusOr<TreeFormat> TreeFormatOf(const std::string& path) {
  static const std::map<std::string, TreeFormat> formats = {
      {".svg", TreeFormat::kSvg}, {".png", TreeFormat::kPng},
      {".glb", TreeFormat::kGlb}, {".obj", TreeFormat::kObj},
      {".swc", TreeFormat::kSwc}, {".csv", TreeFormat::kCsv}};
  const auto found =
      formats.find(std::filesystem::path(path).extension().string());
  if (found != formats.end()) return found->second;
  return absl::InvalidArgumentError(
      "--out: must end in .svg, .png, .glb, .obj, .swc or .csv, got \"" + path +
      "\"");
}

absl::Status WriteTree(const ChosenTree& tree, const TreeFileOptions& options,
                       TreeBackend* backend, std::stop_token stop,
                       TreeSummary* summary) {
  const absl::StatusOr<TreeFormat> format = TreeFormatOf(options.out);
  if (!format.ok()) return format.status();
  if (*format != TreeFormat::kGlb) {
    const absl::Status one = OneLevel(options);
    if (!one.ok()) return one;
  }
  return IsRowFile(*format, tree, options)
             ? WriteRows(*format, tree, options, backend, std::move(stop),
                         summary)
             : WriteModels(*format, tree, options, backend, std::move(stop),
                           summary);
}

absl::Status WriteForest(const ChosenTree& tree, const Forest& forest,
                         const TreeFileOptions& options, TreeBackend* backend,
                         std::stop_token stop, TreeSummary* summary) {
  const absl::StatusOr<TreeFormat> format = TreeFormatOf(options.out);
  if (!format.ok()) return format.status();
  const absl::Status one = OneLevel(options);
  if (!one.ok()) return one;
  switch (*format) {
    case TreeFormat::kSwc:
      return WriteTable<core::SwcForest>(tree, forest, options, backend,
                                         std::move(stop), summary);
    case TreeFormat::kCsv:
      return WriteTable<core::TreeCsvForest>(tree, forest, options, backend,
                                             std::move(stop), summary);
    case TreeFormat::kGlb:
      return WriteForestModel(tree, forest, options, backend, std::move(stop),
                              summary);
    default:
      return absl::InvalidArgumentError(
          "--out: a forest is written as .glb, .swc or .csv, got \"" +
          options.out + "\"");
  }
}

}  // namespace terrane::client
