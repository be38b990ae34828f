#include <gtest/gtest.h>

#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "apps/samples/animal.h"
#include "apps/samples/dense.h"
#include "apps/samples/edits.h"
#include "apps/samples/meshes.h"
#include "apps/samples/scanner.h"
#include "apps/samples/splats.h"
#include "engine/document/edit.h"
#include "engine/document/selection.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/topology.h"
#include "engine/io/io.h"
#include "tests/apps/samples_figures.h"

namespace sinew::samples {

TEST(Samples, AnimalHasAsManyPointsAsAskedFor) {
  for (const std::size_t count : {1000u, 10'002u, 79'226u, 85'792u}) EXPECT_EQ(sample_animal(count).size(), count);
}

TEST(Samples, AnimalIsTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  const Shape one = sample_animal(20'000);
  set_thread_count(3);
  EXPECT_EQ(hash_of(sample_animal(20'000)), hash_of(one));
  EXPECT_NE(hash_of(sample_animal(20'000, 2)), hash_of(one));
}

TEST(Samples, AnimalStandsAndLooksLikeAScan) {
  const Shape shape = sample_animal(79'000);
  EXPECT_TRUE(all_finite(shape));
  EXPECT_STREQ(representation(shape), "point cloud");
  EXPECT_GT(connected_components(shape).count, 150u);

  ASSERT_EQ(shape.attributes.size(), 5u);
  EXPECT_EQ(shape.find("color")->kind, Kind::Color);
  EXPECT_EQ(shape.find("normal")->kind, Kind::Normal);
  EXPECT_EQ(shape.find("scan")->kind, Kind::Id);
  const Attribute &normal = *shape.find("normal"), &scan = *shape.find("scan"), &intensity = *shape.find("intensity"),
                  &confidence = *shape.find("confidence");
  double highest = 0, last_scan = 0;
  std::size_t below = 0;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    highest = std::max(highest, shape.positions[i].y());
    below += shape.positions[i].y() < -0.005;
    const Vec3 n(normal.number(i, 0), normal.number(i, 1), normal.number(i, 2));
    ASSERT_NEAR(n.norm(), 1, 1e-5);
    ASSERT_GE(scan.number(i, 0), last_scan) << "scans follow each other";
    last_scan = scan.number(i, 0);
    ASSERT_TRUE(intensity.number(i, 0) >= 0 && intensity.number(i, 0) <= 1);
    ASSERT_TRUE(confidence.number(i, 0) >= 0 && confidence.number(i, 0) <= 1);
  }
  EXPECT_NEAR(highest, 2.1, 0.15);
  EXPECT_LT(below, 30u) << "only points in the air lie below the ground";
  EXPECT_GE(last_scan, 17);
}

TEST(Samples, AreTheSameOnEveryMachine) {
  EXPECT_EQ(hash_of(sample_animal(79'000)), 12429655721976024917u);
  EXPECT_EQ(hash_of(bumpy_plane()), 10467371887320229418u);
  EXPECT_EQ(hash_of(cylinder()), 1120494238152372246u);
  EXPECT_EQ(hash_of(cactus()), 16943169271759878298u);
  EXPECT_EQ(hash_of(sample_splats(30'000)), 5134577945623130890u);
}

TEST(Samples, MeshesHaveTheCountsOfTheirCases) {
  EXPECT_EQ(bumpy_plane().size(), 40'401u);
  EXPECT_EQ(bar().size(), 6'082u);
  EXPECT_EQ(cylinder().size(), 4'802u);
  EXPECT_NEAR(double(cactus().size()), 5'000, 100);
  EXPECT_EQ(box({3, 2, 1}, Vec3(1, 2, 4)).size(), 24u);
  EXPECT_EQ(bumpy_slab(120, 120).size(), 2u * 121 * 121);
  EXPECT_EQ(cylinder(10, 2, 5).size(), 2u + 10 * 9);
}

TEST(Samples, MeshesAreClosedAndTurnedOutwards) {
  const std::map<std::string, std::pair<Shape, double>> cases{{"bar", {bar(), 0.5 * 1.65 * 0.5}},
                                                              {"cylinder", {cylinder(), 0.0361}},
                                                              {"cactus", {cactus(), 0.031}},
                                                              {"box", {box({3, 2, 1}, Vec3(1, 2, 4)), 3 * 4 * 4}},
                                                              {"slab", {bumpy_slab(120, 120), 0.02 + 0.015 / 4}},
                                                              {"finer cylinder", {cylinder(96, 12, 176), 0.0361}}};
  for (const auto& [name, made] : cases) {
    const Shape& shape = made.first;
    SCOPED_TRACE(name);
    EXPECT_TRUE(all_finite(shape));
    EXPECT_EQ(connected_components(shape).count, 1u);
    EXPECT_TRUE(quality_of(shape, shape.positions).closed);
    EXPECT_NEAR(volume6(shape) / 6, made.second, 0.02 * made.second);
    EXPECT_EQ(shape.size() - edges_of(shape.faces).size() + shape.faces.size(), 2u) << "Euler: no handles";
  }
  const Shape plane = bumpy_plane();
  EXPECT_FALSE(quality_of(plane, plane.positions).closed);
  for (const Vec3& n : vertex_normals(plane)) ASSERT_GT(n.y(), 0.3);
}

TEST(Samples, EditsTakeHoldOfTheirShapes) {
  const std::map<std::string, Shape> shapes{{"scan", sample_animal(79'000)},
                                            {"plane", bumpy_plane()},
                                            {"bar", bar()},
                                            {"cactus", cactus()},
                                            {"cylinder", cylinder()},
                                            {"splats", sample_splats(30'000)},
                                            {"slab", bumpy_slab(120, 120)}};
  std::vector<std::tuple<std::string, std::string, std::string>> edits;  // sample, method, text
  for (const auto& [name, shape] : shapes) {
    edits.emplace_back(name, name == "slab" ? "tet" : "graph", edit_of(name));
    for (const auto& [more, text] : more_edits_of(name))
      edits.emplace_back(name, more == "shell" ? "shell" : "tet", text);
  }
  EXPECT_EQ(edits.size(), shapes.size() + 8);
  for (const auto& [name, method, text] : edits) {
    SCOPED_TRACE(name + " " + method);
    const Shape& shape = shapes.at(name);
    const document::Project edit = document::parse_edit(name + ".edit.json", text);
    ASSERT_EQ(edit.layers.size(), 1u);
    const document::Layer& layer = edit.layers[0];
    EXPECT_EQ(layer.method, method);
    document::Selector selector(std::make_shared<const Shape>(shape));
    const Constraints constraints = selector.constraints(layer, shape.positions);
    ASSERT_EQ(constraints.handles.size(), 1u);
    const Handle& handle = constraints.handles[0];
    EXPECT_GT(constraints.fixed.size(), 50u);
    EXPECT_GT(handle.points.size(), 50u);
    EXPECT_LT(constraints.fixed.size() + handle.points.size(), shape.size() * 3 / 5);
    double farthest = 0;
    for (std::size_t i = 0; i < handle.points.size(); ++i)
      farthest = std::max(farthest, (handle.targets[i] - shape.positions[handle.points[i]]).norm());
    EXPECT_GT(farthest, 0.3);
  }
}

TEST(Samples, FilesComeBackAsTheyWere) {
  const auto folder = std::filesystem::temp_directory_path() / ("sinew-samples-test-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  for (const auto& [name, shape] :
       {std::pair<std::string, Shape>{"scan.ply", sample_animal(5000)}, {"bar.obj", bar()}}) {
    SCOPED_TRACE(name);
    const std::string path = folder / name;
    io::write(path, shape);
    const auto back = io::read(path);
    EXPECT_TRUE(back->positions == shape.positions);
    ASSERT_EQ(back->attributes.size(), shape.attributes.size());
    for (std::size_t i = 0; i < shape.attributes.size(); ++i) EXPECT_EQ(back->attributes[i], shape.attributes[i]);
    EXPECT_EQ(back->faces.points, shape.faces.points);
  }
  std::filesystem::remove_all(folder);
}

TEST(Samples, SplatsAreDiscsOnTheSkin) {
  set_thread_count(1);
  const Shape one = sample_splats(4000);
  set_thread_count(3);
  const Shape shape = sample_splats(4000);
  set_thread_count(2);
  EXPECT_EQ(hash_of(one), hash_of(shape));
  EXPECT_TRUE(all_finite(shape));
  const Attribute &rot = *shape.find("rot"), &scale = *shape.find("scale"), &rest = *shape.find("f_rest");
  std::size_t shining = 0;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const Vec3& p = shape.positions[i];
    const Implicit::Parts parts = animal().near_point(p, 0.02);
    ASSERT_LT(std::abs(animal().distance(p, parts)), 1e-4);
    const Eigen::Quaterniond q(rot.number(i, 0), rot.number(i, 1), rot.number(i, 2), rot.number(i, 3));
    ASSERT_NEAR(q.norm(), 1, 1e-6);
    ASSERT_NEAR((q * Vec3::UnitZ()).dot(animal().normal(p, parts)), 1, 1e-3) << "the third axis is the normal";
    ASSERT_LT(scale.number(i, 2), scale.number(i, 1) - 2) << "flat";
    shining += rest.number(i, 0) != 0;
  }
  EXPECT_GT(shining, shape.size() / 4);
}

TEST(Samples, ASplatFileHasTheOrderThatReadersByPositionExpect) {
  const auto folder = std::filesystem::temp_directory_path() / ("sinew-splats-test-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const std::string path = folder / "splats.ply", again = folder / "again.ply";
  io::write(path, sample_splats(500));
  std::string expected = "ply\nformat binary_little_endian 1.0\nelement vertex 500\n";
  const auto property = [&](const std::string& name, int count = -1) {
    for (int i = 0; i < std::max(count, 1); ++i)
      expected += "property float " + name + (count < 0 ? "" : std::to_string(i)) + "\n";
  };
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) property(name);
  property("f_dc_", 3);
  property("f_rest_", 45);
  property("opacity");
  property("scale_", 3);
  property("rot_", 4);
  expected += "end_header\n";
  const std::vector<std::byte> bytes = io::load_bytes(path);
  ASSERT_EQ(bytes.size(), expected.size() + 500 * 62 * sizeof(float));
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), expected.size()), expected);

  // Read and bent (here: one value changed), the rest of the bytes are those of the file.
  Shape shape = *io::read(path);
  io::write(again, shape);
  EXPECT_TRUE(io::load_bytes(again) == bytes);
  shape.find("rot")->set_number(7, 0, 2);
  io::write(again, shape, true);
  std::vector<std::byte> changed = bytes;
  const float two = 2;
  std::memcpy(&changed[expected.size() + (7 * 62 + 58) * sizeof(float)], &two, sizeof(two));
  EXPECT_TRUE(io::load_bytes(again) == changed);
  std::filesystem::remove_all(folder);
}

TEST(Samples, DenseAnimalIsOnePointAfterTheOther) {
  const auto folder = std::filesystem::temp_directory_path() / ("sinew-dense-test-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  write_dense_animal(folder / "few.ply", 1000, true);
  write_dense_animal(folder / "more.ply", 3000, true);
  const auto few = io::read(folder / "few.ply"), more = io::read(folder / "more.ply");
  ASSERT_EQ(few->size(), 1000u);
  ASSERT_EQ(more->size(), 3000u);
  EXPECT_TRUE(std::equal(few->positions.begin(), few->positions.end(), more->positions.begin()));
  for (std::size_t i = 0; i < more->size(); ++i) ASSERT_GE(more->positions[i].y(), -1e-5);
  EXPECT_TRUE(all_finite(*more));
  std::filesystem::remove_all(folder);
}

}  // namespace sinew::samples
