#include "client/commands/render_subject.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

namespace terrane::client {
namespace {

enum class Subject {
  kRaster,
  kProfile,
  kSideBySide,
  kTerrain,
  kSurface,
  kTree,
  kFlower
};

struct Shown {
  Subject subject;
  bool traced;
  std::optional<v1::RenderStyle> style;

  bool Is(std::initializer_list<Subject> subjects) const {
    return std::find(subjects.begin(), subjects.end(), subject) !=
           subjects.end();
  }
  bool IsFile() const {
    return Is({Subject::kRaster, Subject::kProfile, Subject::kSideBySide});
  }
  std::string Name() const;
};

std::string Shown::Name() const {
  switch (subject) {
    case Subject::kRaster:
      return "a raster";
    case Subject::kProfile:
      return "a profile's file";
    case Subject::kSideBySide:
      return "rasters side by side";
    case Subject::kTerrain:
      return traced ? "a traced terrain" : "a terrain";
    case Subject::kSurface:
      return traced ? "a traced surface" : "a surface";
    case Subject::kTree:
      return "a tree, which is traced";
    case Subject::kFlower:
      return "a flower, which is traced";
  }
  return "";
}

Shown ShownBy(const RenderCommand& command) {
  const auto subject = [&command] {
    if (!command.side_by_side.empty()) return Subject::kSideBySide;
    if (command.input.ends_with(".csv")) return Subject::kProfile;
    if (!command.input.empty()) return Subject::kRaster;
    if (IsSurface(command)) return Subject::kSurface;
    if (IsTree(command)) return Subject::kTree;
    if (IsFlower(command)) return Subject::kFlower;
    return Subject::kTerrain;
  };
  return {subject(), IsTraced(command), command.style};
}

bool IsGenerated(const Shown& shown) { return !shown.IsFile(); }

bool HasStyles(const Shown& shown) {
  if (shown.style == v1::RENDER_STYLE_TRACED) return true;
  return shown.Is({Subject::kRaster, Subject::kTerrain}) ||
         (shown.subject == Subject::kSurface &&
          shown.style == v1::RENDER_STYLE_PERSPECTIVE);
}

bool IsSeenFromTheSide(const Shown& shown) {
  return !shown.IsFile() || (shown.subject == Subject::kRaster &&
                             shown.style == v1::RENDER_STYLE_PERSPECTIVE);
}

// A terrain may have one dimension.
bool MayBePlotted(const Shown& shown) {
  return !shown.traced && shown.Is({Subject::kProfile, Subject::kTerrain});
}

bool IsTerrain(const Shown& shown) { return shown.Is({Subject::kTerrain}); }

// Of an option or, behind those, of a group of them: what it is for.
struct Rule {
  std::string_view name;
  std::string_view purpose;
  bool (*heeds)(const Shown& shown);
};

constexpr Rule kRules[] = {
    {"--preset", "what is generated", IsGenerated},
    {"--seed", "what is generated", IsGenerated},
    {"--band", "rasters",
     [](const Shown& s) {
       return s.Is({Subject::kRaster, Subject::kSideBySide});
     }},
    {"--style", "terrains, rasters and traced pictures", HasStyles},
    {"--exaggeration", "terrains, rasters and surfaces that are not traced",
     [](const Shown& s) {
       return s.Is({Subject::kRaster, Subject::kSideBySide,
                    Subject::kTerrain}) ||
              (s.subject == Subject::kSurface && !s.traced);
     }},
    {"--water-level", "terrains that are not traced, rasters and profiles",
     [](const Shown& s) {
       return !s.traced &&
              s.Is({Subject::kRaster, Subject::kProfile, Subject::kTerrain});
     }},
    {"--marks", "profiles", MayBePlotted},
    {"--title", "profiles", MayBePlotted},
    {"--show-spots", "terrains that are not traced",
     [](const Shown& s) { return !s.traced && IsTerrain(s); }},
    {"--light", "what is lit",
     [](const Shown& s) { return !s.Is({Subject::kProfile}); }},
    {"--turn", "views in perspective", IsSeenFromTheSide},
    {"--tilt", "views in perspective", IsSeenFromTheSide},
    {"--control-net", "surfaces that are not traced",
     [](const Shown& s) { return !s.traced && s.Is({Subject::kSurface}); }},
    {"Terrain", "terrains", IsTerrain},
    {"Samples", "terrains", IsTerrain},
    {"Surface", "surfaces",
     [](const Shown& s) { return s.Is({Subject::kSurface}); }},
    {"Flower", "flowers",
     [](const Shown& s) { return s.Is({Subject::kFlower}); }},
    {"Traced picture", "traced pictures",
     [](const Shown& s) { return s.traced; }},
};

const Rule* RuleOf(const CLI::Option& option) {
  for (const std::string& name : {option.get_name(), option.get_group()}) {
    const Rule* const rule =
        std::find_if(std::begin(kRules), std::end(kRules),
                     [&name](const Rule& one) { return one.name == name; });
    if (rule != std::end(kRules)) return rule;
  }
  return nullptr;
}

}  // namespace

absl::Status CheckOptionsAreHeeded(const CLI::App& parsed,
                                   const RenderCommand& command) {
  const Shown shown = ShownBy(command);
  for (const CLI::Option* option : parsed.get_options()) {
    const Rule* const rule = RuleOf(*option);
    if (option->count() == 0 || rule == nullptr || rule->heeds(shown)) continue;
    return absl::InvalidArgumentError(
        fmt::format("{}: is of {}, the picture is of {}", option->get_name(),
                    rule->purpose, shown.Name()));
  }
  return absl::OkStatus();
}

}  // namespace terrane::client
