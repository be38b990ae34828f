#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "apps/samples/edits.h"
#include "apps/samples/soup.h"
#include "engine/document/edit.h"
#include "engine/document/selection.h"
#include "engine/geometry/topology.h"
#include "engine/io/io.h"
#include "tests/apps/samples_figures.h"

namespace sinew::samples {

namespace {

class Soup : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    io::save_bytes(path_, std::as_bytes(std::span(text_)), true);
    shape_ = io::read(path_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("sinew-soup-test-" + std::to_string(getpid()));
  std::string text_ = chair("soup.mtl"), path_ = folder_ / "soup.obj";
  std::shared_ptr<const Shape> shape_;
};

/// The lines of an OBJ file without its points.
std::string without_points(const std::string& text) {
  std::string rest, line;
  for (std::istringstream in(text); std::getline(in, line);)
    if (!line.starts_with("v ")) rest += line + "\n";
  return rest;
}

}  // namespace

TEST_F(Soup, HasWhatMakesSoupsHard) {
  EXPECT_TRUE(all_finite(*shape_));
  std::map<std::size_t, int> by_corners;
  std::map<std::pair<Index, Index>, int> faces_of_edge;
  for (std::size_t f = 0; f < shape_->faces.size(); ++f) {
    const auto corners = shape_->faces[f];
    ++by_corners[corners.size()];
    EXPECT_EQ(std::set<Index>(corners.begin(), corners.end()).size(), corners.size());
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Index a = corners[k], b = corners[(k + 1) % corners.size()];
      ++faces_of_edge[{std::min(a, b), std::max(a, b)}];
    }
  }
  EXPECT_EQ(by_corners[24], 2) << "the seat's underside and hollow";
  EXPECT_EQ(by_corners[12], 8) << "ends of legs";
  EXPECT_GT(by_corners[4], 2000);
  std::map<int, int> edges;
  for (const auto& [edge, faces] : faces_of_edge) ++edges[faces];
  EXPECT_EQ(edges[3], 20) << "along the rib of the splat";
  EXPECT_GT(edges[2], 1000) << "joined parts";
  EXPECT_GT(edges[1], 4000) << "loose polygons";
  EXPECT_GT(connected_components(*shape_).count, 1000u);
  for (const Vec3& p : shape_->positions) ASSERT_GE(p.y(), 0);
}

TEST_F(Soup, PolygonsLookOutwards) {
  // The closed parts enclose wood; the splat is a sheet, and adds next to nothing.
  double volume = 0;
  const std::vector<Index> corners = triangles_of(shape_->faces);
  for (std::size_t t = 0; t < corners.size(); t += 3)
    volume +=
        shape_->positions[corners[t]].cross(shape_->positions[corners[t + 1]]).dot(shape_->positions[corners[t + 2]]) /
        6;
  EXPECT_NEAR(volume, 0.0085, 0.002);
}

TEST_F(Soup, NamesMaterialsAndGroups) {
  std::set<std::string> used, groups;
  std::string word, name;
  for (std::istringstream in(text_); in >> word;) {
    if (word == "usemtl" && in >> name) used.insert(name);
    if (word == "g" && in >> name) groups.insert(name);
  }
  EXPECT_EQ(groups.size(), 9u);
  EXPECT_EQ(used.size(), 3u);
  for (const std::string& material : used)
    EXPECT_NE(chair_materials().find("newmtl " + material + "\n"), std::string::npos) << material;
}

TEST_F(Soup, EditTakesHoldOfIt) {
  const document::Project edit = document::parse_edit("soup.edit.json", edit_of("soup"));
  document::Selector selector(shape_);
  const Constraints constraints = selector.constraints(edit.layers.at(0), shape_->positions);
  ASSERT_EQ(constraints.handles.size(), 1u);
  EXPECT_GT(constraints.fixed.size(), 100u);
  EXPECT_GT(constraints.handles[0].points.size(), 100u);
}

TEST_F(Soup, StaysASoupWhenBentAndWritten) {
  Shape bent = *shape_;
  for (Vec3& p : bent.positions) p += Vec3(0, 0.1 * p.x(), 0);
  const std::string out = folder_ / "bent.obj";
  io::write(out, bent);
  const std::vector<std::byte> bytes = io::load_bytes(out);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_NE(text, text_);
  EXPECT_EQ(without_points(text), without_points(text_));
}

TEST_F(Soup, IsTheSameOnEveryMachine) {
  EXPECT_EQ(hash_of(std::as_bytes(std::span(text_))), 8309010183307283803u);
}

}  // namespace sinew::samples
