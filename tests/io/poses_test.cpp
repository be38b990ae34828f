#include "engine/io/poses.h"

#include <gtest/gtest.h>

#include "engine/geometry/error.h"
#include "engine/io/sequence.h"
#include "tests/io/file_checks.h"
#include "tests/io/temporary_folder.h"

namespace sinew::io {

namespace {

Shape triangle(double height) {
  Shape out;
  out.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, height, 0)};
  out.faces.add(std::array<Index, 3>{0, 1, 2});
  return out;
}

std::vector<std::string> names(const std::vector<NamedPose>& poses) {
  std::vector<std::string> out;
  for (const NamedPose& pose : poses) out.push_back(pose.name);
  return out;
}

double height(const NamedPose& pose) {
  return pose.shape->positions[2].y() + pose.shape->origin.y();
}

}  // namespace

TEST(Poses, NamesComeInTheOrderThatPeopleCount) {
  EXPECT_TRUE(in_natural_order("pose2", "pose10"));
  EXPECT_FALSE(in_natural_order("pose10", "pose2"));
  EXPECT_TRUE(in_natural_order("a9b1", "a9b02"));
  EXPECT_TRUE(in_natural_order("a", "b"));
  EXPECT_TRUE(in_natural_order("pose", "pose1"));
  EXPECT_TRUE(in_natural_order("123456789012345678901234567890", "123456789012345678901234567891"));
  EXPECT_NE(in_natural_order("a01", "a1"), in_natural_order("a1", "a01")) << "one of equal numbers is first";
  EXPECT_FALSE(in_natural_order("a", "a"));
}

TEST(Poses, AFolderGivesItsMeshesInOrder) {
  const TemporaryFolder folder;
  for (const int k : {10, 2, 1}) write(folder / ("p" + std::to_string(k) + ".obj"), triangle(k));
  save_bytes(folder / "readme.txt2", {}, false);
  std::filesystem::create_directory(folder / "more.obj");
  const std::vector<NamedPose> poses = read_poses(folder.path().string());
  EXPECT_EQ(names(poses), (std::vector<std::string>{"p1", "p2", "p10"}));
  EXPECT_EQ(height(poses[2]), 10);
  EXPECT_EQ(poses[1].path, folder / "p2.obj");
}

TEST(Poses, AnEmptyFolderIsToldByItsName) {
  const TemporaryFolder folder;
  try {
    read_poses(folder.path().string());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              folder.path().string() + ": expected files of poses in the folder, found none of a known format");
  }
}

TEST(Poses, AFileIsOneAndARunIsAllOfItsFrames) {
  const TemporaryFolder folder;
  for (const int k : {1, 2, 3}) write(folder / ("walk.000" + std::to_string(k) + ".obj"), triangle(k));
  EXPECT_EQ(names(read_poses(folder / "walk.0002.obj")), (std::vector<std::string>{"walk.0002"}));
  const std::vector<NamedPose> run = read_poses(folder / "walk.####.obj");
  ASSERT_EQ(run.size(), 3U);
  EXPECT_EQ(height(run[1]), 2);
  EXPECT_NE(run[0].name, run[1].name);
}

TEST(Poses, MorphTargetsOfGltfArePosesEachInItsOwnRight) {
  const TemporaryFolder folder;
  const std::string path = folder / "face.glb";
  FrameWriterOptions options;
  options.frames = {1, 2, 3};
  const auto writer = create_frames(path, options);
  for (const int k : {1, 2, 3}) writer->write(k, triangle(k));
  writer->commit();
  const std::vector<NamedPose> poses = read_poses(path);
  EXPECT_EQ(names(poses), (std::vector<std::string>{"face 1", "face 2"})) << "the first frame is the base mesh";
  EXPECT_EQ(height(poses[0]), 2);
  EXPECT_EQ(height(poses[1]), 3);
}

}  // namespace sinew::io
