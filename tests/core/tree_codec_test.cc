// SWC, CSV and SVG of trees, read back by readers of their own: the same rows.
#include <cstdint>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/codec/svg.h"
#include "core/codec/swc.h"
#include "core/codec/tree_csv.h"
#include "gtest/gtest.h"
#include "tests/core/whole_tree.h"

namespace terrane::core {
namespace {

std::vector<TreeSpec> Specs() {
  std::vector<TreeSpec> specs(5);
  for (TreeSpec& spec : specs) {
    spec.length_mode = LengthMode::kRelative;
    spec.dimensions = 3;
    spec.depth = 6;
    spec.seed = &spec - specs.data();
  }
  specs[1].bending = {4, 1, 0.3};
  specs[2].genetic.leader = true;
  specs[3].form = TreeForm::kPlain;
  specs[3].dimensions = 2;
  specs[3].plain.offset = 0.7;
  specs[4].form = TreeForm::kCantor;
  specs[4].dimensions = 2;
  return specs;
}

struct SwcNode {
  int type;
  Float3 place;
  float radius;
  int parent;
  std::size_t row;
};

TEST(Swc, ReadsBackAsTheSameTree) {
  for (const TreeSpec& spec : Specs()) {
    const SegmentBlock tree = Grow(spec);
    std::istringstream text(EncodeSwc(tree));
    std::map<int, SwcNode> nodes;
    std::size_t rows = 0;
    for (std::string line; std::getline(text, line);) {
      if (line[0] == '#') continue;
      std::istringstream fields(line);
      int id = 0;
      SwcNode node = {};
      fields >> id >> node.type >> node.place.x >> node.place.y >>
          node.place.z >> node.radius >> node.parent;
      ASSERT_FALSE(fields.fail()) << line;
      ASSERT_EQ(id, static_cast<int>(nodes.size()) + 1);
      ASSERT_LT(node.parent, id);
      if (node.type == kSwcStart) {
        const std::size_t row = rows++;
        ASSERT_EQ(node.place, tree.start[row]);
        ASSERT_EQ(node.radius, tree.radius_start[row]);
        const std::uint32_t parent =
            node.parent == -1
                ? kNoParent
                : static_cast<std::uint32_t>(nodes[node.parent].row);
        ASSERT_EQ(parent, tree.parent[row]);
      } else {
        ASSERT_EQ(nodes[node.parent].row, rows - 1);
      }
      node.row = rows - 1;
      if (node.type == kSwcEnd) {
        ASSERT_EQ(node.place, tree.end[node.row]);
        ASSERT_EQ(node.radius, tree.radius_end[node.row]);
      }
      nodes[id] = node;
    }
    EXPECT_EQ(rows, tree.rows());
  }
}

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream text(line);
  for (std::string field; std::getline(text, field, ',');) {
    fields.push_back(field);
  }
  return fields;
}

TEST(TreeCsv, ReadsBackAsTheSameTree) {
  for (const TreeSpec& spec : Specs()) {
    const SegmentBlock tree = Grow(spec);
    std::istringstream text(EncodeTreeCsv(tree));
    std::string line;
    ASSERT_TRUE(std::getline(text, line));
    std::map<std::string, std::size_t> column;
    for (const std::string& name : Split(line)) {
      const std::size_t index = column.size();
      column[name] = index;
    }
    std::vector<std::uint32_t> extension_of(tree.rows() + 1);
    for (std::size_t row = 0; row < tree.rows(); ++row) {
      ASSERT_TRUE(std::getline(text, line));
      const std::vector<std::string> fields = Split(line);
      ASSERT_EQ(fields.size(), column.size());
      const auto number = [&](const char* name) {
        return std::strtof(fields[column.at(name)].c_str(), nullptr);
      };
      const auto whole = [&](const char* name) {
        return static_cast<std::uint32_t>(
            std::strtoul(fields[column.at(name)].c_str(), nullptr, 10));
      };
      const Float3 start = {number("start_x"), number("start_y"),
                            number("start_z")};
      const Float3 end = {number("end_x"), number("end_y"), number("end_z")};
      ASSERT_EQ(start, tree.start[row]);
      ASSERT_EQ(end, tree.end[row]);
      ASSERT_NEAR(
          static_cast<double>(start.z + number("axis_z") * number("length")),
          static_cast<double>(end.z), 1e-3);
      ASSERT_EQ(number("radius"), tree.radius_start[row]);
      ASSERT_EQ(number("radius_end"), tree.radius_end[row]);
      ASSERT_EQ(number("attach"), tree.attach[row]);
      ASSERT_EQ(whole("flags"), tree.flags[row]);
      ASSERT_EQ(whole("chromosome"), tree.chromosome[row]);
      ASSERT_EQ(whole("parent") - 1, tree.parent[row]);
      extension_of[row] = whole("extension");
      const bool goes_on = row > 0 && extension_of[tree.parent[row]] == row + 1;
      ASSERT_EQ(whole("position_in_branch") > 1, goes_on);
    }
    EXPECT_FALSE(std::getline(text, line));
  }
}

// Attributes of a line of SVG.
float Attribute(const std::string& line, const std::string& name) {
  const std::size_t at = line.find(" " + name + "=\"");
  EXPECT_NE(at, std::string::npos) << line;
  return std::strtof(line.c_str() + at + name.size() + 3, nullptr);
}

TEST(TreeSvg, HasALineForEveryRowInAGroupForEachGeneration) {
  for (const TreeSpec& spec : Specs()) {
    const SegmentBlock tree = Grow(spec);
    std::istringstream text(EncodeTreeSvg(tree, "#432"));
    std::size_t row = 0;
    int groups = 0, depth = 0;
    for (std::string line; std::getline(text, line);) {
      if (line.starts_with("<g ")) ++depth;
      if (line.starts_with("</g>")) --depth;
      groups += line.starts_with("<g id=\"generation-");
      if (!line.starts_with("<line")) continue;
      ASSERT_EQ(depth, 2);
      ASSERT_EQ(Attribute(line, "x1"), tree.start[row].x);
      ASSERT_EQ(Attribute(line, "y1"), -tree.start[row].z);
      ASSERT_EQ(Attribute(line, "x2"), tree.end[row].x);
      ASSERT_EQ(Attribute(line, "y2"), -tree.end[row].z);
      ASSERT_GT(Attribute(line, "stroke-width"), 0);
      ++row;
    }
    EXPECT_EQ(row, tree.rows());
    EXPECT_EQ(depth, 0);
    EXPECT_EQ(groups, 7);
  }
}

// The lines of a text as words.
std::vector<std::vector<std::string>> Words(const std::string& text,
                                            char separator) {
  std::vector<std::vector<std::string>> lines;
  std::istringstream input(text);
  for (std::string line; std::getline(input, line);) {
    std::istringstream words(line);
    lines.emplace_back();
    for (std::string word; std::getline(words, word, separator);) {
      lines.back().push_back(word);
    }
  }
  return lines;
}

TEST(TreeForests, SwcIdsGoOnFromTreeToTree) {
  EXPECT_EQ(SwcForest::Header(), "# id type x y z radius parent\n");
  SwcForest forest;
  std::size_t before = 0;
  for (const TreeSpec& spec : Specs()) {
    const SegmentBlock tree = Grow(spec);
    auto expected = Words(EncodeSwc(tree), ' ');
    expected.erase(expected.begin());  // the header
    for (std::vector<std::string>& node : expected) {
      node[0] = std::to_string(std::stoul(node[0]) + before);
      if (node[6] != "-1") {
        node[6] = std::to_string(std::stoul(node[6]) + before);
      }
    }
    ASSERT_EQ(Words(forest.Add(tree), ' '), expected);
    before += expected.size();
  }
}

TEST(TreeForests, CsvLinesGoOnFromTreeToTree) {
  constexpr std::size_t kParent = 8;
  constexpr std::size_t kExtension = 9;
  EXPECT_TRUE(TreeCsvForest::Header().ends_with(",chromosome,tree\n"));
  TreeCsvForest forest;
  std::size_t before = 0;
  std::size_t number = 0;
  for (const TreeSpec& spec : Specs()) {
    const SegmentBlock tree = Grow(spec);
    auto expected = Words(EncodeTreeCsv(tree), ',');
    expected.erase(expected.begin());  // the header
    for (std::vector<std::string>& row : expected) {
      for (const std::size_t column : {kParent, kExtension}) {
        if (row[column] == "0") continue;
        row[column] = std::to_string(std::stoul(row[column]) + before);
      }
      row.push_back(std::to_string(number));
    }
    ASSERT_EQ(Words(forest.Add(tree), ','), expected);
    before += expected.size();
    ++number;
  }
}

TEST(TreeCodecs, TakeATreeWithoutRows) {
  EXPECT_EQ(EncodeSwc({}), "# id type x y z radius parent\n");
  EXPECT_TRUE(EncodeTreeCsv({}).starts_with("radius,length,"));
  EXPECT_TRUE(EncodeTreeSvg({}, "black").starts_with("<svg "));
}

}  // namespace
}  // namespace terrane::core
