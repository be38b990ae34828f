// Real soups and meshes of many parts, from file to bent file: every part follows, and nothing but the numbers of
// positions and normals differs from the file's bytes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "deformers/methods.h"
#include "engine/document/evaluate.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/neighbour_graph.h"
#include "engine/io/io.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::document {

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool starts(std::string_view line, std::string_view word) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  return line.starts_with(word) && line.size() > word.size() && std::strchr(" \t", line[word.size()]) != nullptr;
}

/// A line with each of its numbers as '#'.
std::string masked_line(std::string_view line) {
  std::string out;
  bool in_word = false, masking = false;
  for (const char c : line) {
    const bool blank = std::strchr(" \t\r\n", c) != nullptr;
    if (!blank && !in_word) {
      masking = std::strchr("+-.0123456789", c) != nullptr;
      if (masking) out += '#';
    }
    in_word = !blank;
    if (blank || !masking) out += c;
  }
  return out;
}

/// The bytes of an OBJ or STL file without the numbers of its points and normals.
std::string masked(const std::string& bytes, bool stl) {
  std::uint32_t triangles = 0;
  if (stl && bytes.size() >= 84) std::memcpy(&triangles, bytes.data() + 80, 4);
  if (stl && bytes.size() == 84 + 50 * static_cast<std::size_t>(triangles)) {
    std::string out = bytes;
    for (std::size_t t = 0; t < triangles; ++t)
      std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(84 + 50 * t), 48, '#');
    return out;
  }
  std::string out;
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', begin), bytes.size() - 1) + 1;
    const std::string_view line(bytes.data() + begin, end - begin);
    const bool numbers =
        stl ? starts(line, "vertex") || starts(line, "facet") : starts(line, "v") || starts(line, "vn");
    out += numbers ? masked_line(line) : std::string(line);
    begin = end;
  }
  return out;
}

Layer layer_of(double distance) {
  Layer layer;
  layer.settings.push_back({"distance", distance == 0 ? std::string("straight") : std::string("surface"), {}});
  return layer;
}

/// The lowest tenth is fixed, the highest leans over.
Layer lean(const Shape& shape, double distance) {
  const Bounds bounds = bounds_of(shape.positions);
  Eigen::Index axis = 1;
  (bounds.max - bounds.min).maxCoeff(&axis);
  const auto box = [&](double from, double to) {
    SelectBox out{bounds.min + shape.origin, bounds.max + shape.origin};
    const double length = bounds.max[axis] - bounds.min[axis];
    out.min[axis] = bounds.min[axis] + from * length + shape.origin[axis];
    out.max[axis] = bounds.min[axis] + to * length + shape.origin[axis];
    return Selection{out, {}};
  };
  Layer layer = layer_of(distance);
  layer.fixed.push_back(box(0, 0.1));
  HandleEdit handle;
  handle.points = box(0.9, 1);
  Rotation rotation;
  rotation.axis = Vec3::Unit((axis + 1) % 3);
  rotation.degrees = 20;
  handle.motion.rotate = rotation;
  handle.motion.move = 0.1 * bounds.diagonal() * Vec3::Unit((axis + 2) % 3);
  layer.handles.push_back(handle);
  return layer;
}

/// One point is carried away; what hangs together follows it as it is.
Layer carry(const Shape& shape, double distance, Index point) {
  Layer layer = layer_of(distance);
  HandleEdit handle;
  handle.points.what = SelectIndices{Shared<Index>({point})};
  handle.motion.move = 0.5 * bounds_of(shape.positions).diagonal() * Vec3(1, 2, -1).normalized();
  layer.handles.push_back(handle);
  return layer;
}

/// Parts with a point that did not go where the handle went, within 1 % of the diagonal.
std::size_t parts_left_behind(const Shape& before, const Shape& after, const Vec3& move) {
  const Places places = places_of(before.positions);
  const GraphParts parts = parts_of(places.at.size(), surface_of(before, places, 1e9).edges);
  std::vector<bool> behind(parts.count, false);
  const double tolerance = 0.01 * bounds_of(before.positions).diagonal();
  for (std::size_t i = 0; i < before.size(); ++i)
    if ((after.positions[i] - before.positions[i] - move).norm() > tolerance)
      behind[parts.of_vertex[places.of_point[i]]] = true;
  return static_cast<std::size_t>(std::count(behind.begin(), behind.end(), true));
}

class RealSoups : public testing::TestWithParam<std::tuple<std::string, double>> {};

std::string case_name(const testing::TestParamInfo<std::tuple<std::string, double>>& parameter) {
  std::string name = std::get<0>(parameter.param) + (std::get<1>(parameter.param) == 0 ? "_straight" : "_surface");
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

}  // namespace

TEST_P(RealSoups, AreBentAndNothingElseDiffers) {
  const auto& [name, distance] = GetParam();
  SHARED_DATA(path, "soups/" + name);
  const auto before = io::read(path.string());
  const double diagonal = bounds_of(before->positions).diagonal();
  const std::vector<Layer> layers = {lean(*before, distance)};
  const Evaluation bent = evaluate(before, layers, methods());
  EXPECT_EQ(bent.reports.at(0).solve.status, Status::Converged) << bent.reports[0].solve.message;
  // A box of 26 points, all held or pulled, gives way, and a hundred triangles at random more.
  EXPECT_LT(bent.reports[0].handle_max, name == "soup.stl" ? 0.2 : 0.07);

  const TemporaryFolder folder;
  const fs::path out = folder.path() / ("bent" + path.extension().string());
  io::write(out.string(), *bent.shape);
  const bool stl = path.extension() != ".obj";
  if (path.extension() != ".ply") {
    const std::string a = masked(text_of(path), stl), b = masked(text_of(out), stl);
    EXPECT_TRUE(a == b) << "differs at byte "
                        << std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin();
  }
  const auto after = io::read(out.string());
  ASSERT_EQ(after->size(), before->size());
  EXPECT_EQ(after->faces.points, before->faces.points);
  EXPECT_EQ(after->faces.offsets, before->faces.offsets);
  ASSERT_EQ(after->attributes.size(), before->attributes.size());
  double most = 0, written = 0;
  for (std::size_t i = 0; i < before->size(); ++i) {
    most = std::max(most, (after->positions[i] + after->origin - before->positions[i] - before->origin).norm());
    written =
        std::max(written, (after->positions[i] + after->origin - bent.shape->positions[i] - before->origin).norm());
  }
  EXPECT_GT(most, 0.09 * diagonal);
  EXPECT_LT(written, 1e-5 * diagonal);
  // Points at one place stay at one place: bending tears no seam, without welding it.
  const Places places = places_of(before->positions);
  std::vector<Index> first(places.at.size(), Places::none);
  for (Index i = 0; i < before->size(); ++i) {
    Index& lowest = first[places.of_point[i]];
    if (lowest == Places::none) lowest = i;
    ASSERT_EQ(bent.shape->positions[i], bent.shape->positions[lowest]);
  }
}

TEST_P(RealSoups, EveryPartFollows) {
  const auto& [name, distance] = GetParam();
  SHARED_DATA(path, "soups/" + name);
  const auto before = io::read(path.string());
  for (const std::size_t at : {std::size_t{0}, before->size() / 2, before->size() - 1}) {
    const std::vector<Layer> layers = {carry(*before, distance, static_cast<Index>(at))};
    const Evaluation bent = evaluate(before, layers, methods());
    // The two bodies of this one stand apart.
    const std::size_t apart = name == "multibody.stl" ? 1 : 0;
    EXPECT_EQ(parts_left_behind(*before, *bent.shape, *layers[0].handles[0].motion.move), apart) << at;
    for (const std::string& note : bent.reports.at(0).notes) EXPECT_TRUE(note.empty()) << note;
  }
}

INSTANTIATE_TEST_SUITE_P(All, RealSoups,
                         testing::Combine(testing::Values("office_chair.obj", "truck.obj", "spider.obj", "male02.obj",
                                                          "teapot.obj", "degenerated.obj", "Spider_binary.stl",
                                                          "busted.STL", "multibody.stl", "soup.stl",
                                                          "cube_with_fold.ply", "many_small_holes.ply",
                                                          "non_manif_hole.ply", "two-boxes-bad-self-union.ply"),
                                          testing::Values(0.0, 1.0)),
                         case_name);

TEST(RealSoupsMask, ShowsWhatDiffersBesidesPositionsAndNormals) {
  const std::string obj = "# v 1 2 3\nv 1 -2e-3 3\nvn 0 0 1\nvt 0.5 0.5\nusemtl v1\nf 1//1 2 3 4\n";
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string out = obj;
    out.replace(out.find(from), from.size(), to);
    return out;
  };
  EXPECT_EQ(masked(with("v 1 -2e-3", "v 17.5 8"), false), masked(obj, false));
  EXPECT_EQ(masked(with("vn 0 0", "vn -.7 .7"), false), masked(obj, false));
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{{"usemtl v1", "usemtl v2"},
                                                                                 {"2 3 4", "2 3 5"},
                                                                                 {"vt 0.5", "vt 0.6"},
                                                                                 {"# v 1", "# v 2"},
                                                                                 {" 3\nvn", "\nvn"},
                                                                                 {"v 1 ", "v  1 "},
                                                                                 {"\nf", "\n\nf"}})
    EXPECT_NE(masked(with(from, to), false), masked(obj, false)) << from;
  std::string stl(84 + 50, 'a');
  const std::uint32_t one = 1;
  std::memcpy(stl.data() + 80, &one, 4);
  for (const std::size_t byte : {0u, 79u, 84u, 131u, 132u, 133u}) {
    std::string other = stl;
    other[byte] = 'b';
    EXPECT_EQ(masked(other, true) == masked(stl, true), byte >= 84 && byte < 132) << byte;
  }
}

}  // namespace sinew::document
