#include "engine/io/scan_set.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "engine/geometry/nearest.h"
#include "tests/io/file_checks.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

/// Two scans of two points with normals, the second turned by 90 degrees about z and moved, and a third that is
/// missing.
struct SmallSet {
  TemporaryFolder folder;
  std::string conf =
      "camera 1 2 3  0 0 0 1\r\nbmesh a.ply 0 0 0 0 0 0 1\n\nbmesh  sub/b.ply 10 0 0  0 0 0.70710678 0.70710678 \n"
      "bmesh c.ply 0 0 0 0 0 0 1\n# end";

  SmallSet() {
    std::filesystem::create_directory(folder / "sub");
    save("a.ply", scan("0 0 0 1 0 0 5\n1 0 0 0 1 0 6\n", "confidence"));
    save("sub/b.ply", scan("0 0.10 0 1.0 0 0 7\n1 2 3 0 1 0 8\n", "intensity"));
    save("set.conf", conf);
  }
  void save(const std::string& name, const std::string& text) const { save_bytes(folder / name, bytes_of(text), true); }
  static std::string scan(const std::string& rows, const std::string& field) {
    return "ply\nformat ascii 1.0\ncomment kept\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
           "z\n"
           "property float nx\nproperty float ny\nproperty float nz\nproperty float " +
           field + "\nend_header\n" + rows;
  }
  std::string text(const std::string& name) const { return text_of_file(folder / name); }
};

Vec3 point(const Shape& shape, std::size_t i) {
  return shape.positions[i] + shape.origin;
}

double median_distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  const NearestTree tree(b);
  std::vector<std::uint32_t> index(a.size());
  std::vector<double> distance(a.size());
  tree.nearest(a, 1, index, distance);
  std::nth_element(distance.begin(), distance.begin() + static_cast<std::ptrdiff_t>(a.size() / 2), distance.end());
  return distance[a.size() / 2];
}

}  // namespace

TEST(ScanSet, OpensInTheWorld) {
  const SmallSet set;
  const auto shape = read(set.folder / "set.conf");
  expect_sound(*shape, "set");
  ASSERT_EQ(shape->size(), 4u);
  ASSERT_EQ(shape->parts.size(), 2u);
  EXPECT_EQ(shape->parts[1].path, "sub/b.ply");
  EXPECT_EQ(shape->parts[1].first, 2u);
  EXPECT_STREQ(representation(*shape), "scan set");
  // The quaternion turns x to y; its inverse takes a point (1, 2, 3) to (2, -1, 3).
  EXPECT_NEAR((point(*shape, 3) - Vec3(12, -1, 3)).norm(), 0, 1e-12);
  ASSERT_EQ(shape->attributes.size(), 1u);
  EXPECT_EQ(shape->attributes[0].name, "normal");
  EXPECT_NEAR(shape->attributes[0].number(2, 1), -1, 1e-7);
  EXPECT_EQ(shape->notes,
            (std::vector<std::string>{
                "1 of 3 scans are missing: \"c.ply\".",
                "The attribute \"confidence\" is not the same in all scans: it is kept in their files and not bent.",
                "The attribute \"intensity\" is not the same in all scans: it is kept in their files and not bent."}));
}

TEST(ScanSet, GoesBackToItsFilesByteForByte) {
  const SmallSet set;
  const auto shape = read(set.folder / "set.conf");
  EXPECT_TRUE(write_parts(set.folder / "out", *shape).lost.empty());
  for (const char* name : {"a.ply", "sub/b.ply", "set.conf"})
    EXPECT_EQ(set.text(std::string("out/") + name), set.text(name)) << name;
}

TEST(ScanSet, OnlyWhatMovedChangesInItsOwnFrame) {
  const SmallSet set;
  Shape shape = *read(set.folder / "set.conf");
  shape.positions[3] += Vec3(0, 0, 0.5);
  Attribute& normal = *shape.find("normal");
  for (int c = 0; c < 3; ++c) normal.set_number(3, c, c == 1 ? 1 : 0);
  write_parts(set.folder / "out", shape);
  EXPECT_EQ(set.text("out/a.ply"), set.text("a.ply"));
  const std::string text = set.text("out/sub/b.ply");
  EXPECT_TRUE(text.find("\n0 0.10 0 1.0 0 0 7\n") != std::string::npos) << text;
  const Shape scan = read_text(read_scan_set, "bmesh sub/b.ply 0 0 0 0 0 0 1\n", set.folder / "out/x.conf");
  EXPECT_NEAR((point(scan, 1) - Vec3(1, 2, 3.5)).norm(), 0, 1e-6);
  EXPECT_NEAR(scan.find("normal")->number(1, 0), -1, 1e-6);
}

TEST(ScanSet, IsWrittenMergedToOneFile) {
  const SmallSet set;
  const auto shape = read(set.folder / "set.conf");
  const WriteReport report = write(set.folder / "merged.ply", *shape);
  EXPECT_EQ(report.lost, (std::vector<std::string>{"PLY cannot hold the division into 2 scans and their poses."}));
  const auto merged = read(set.folder / "merged.ply");
  ASSERT_EQ(merged->size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR((point(*merged, i) - point(*shape, i)).norm(), 0, 1e-6);
}

TEST(ScanSet, IsWrittenBesideAConfOfAnotherName) {
  const SmallSet set;
  const auto shape = read(set.folder / "set.conf");
  std::filesystem::create_directory(set.folder / "out");
  write(set.folder / "out/new.conf", *shape);
  EXPECT_EQ(set.text("out/new.conf"), set.conf);
  EXPECT_EQ(set.text("out/a.ply"), set.text("a.ply"));
  EXPECT_EQ(refusal(
                [](const std::string& path, std::vector<std::byte>, const ReadOptions&) {
                  write(path, *read(path));
                  return Shape{};
                },
                "", set.folder / "set.conf"),
            (set.folder / "a.ply") + ": expected the name of a new file, found an existing one (--force replaces it)");
}

TEST(ScanSet, AScanOutsideTheFolderIsWrittenInside) {
  const SmallSet set;
  std::filesystem::create_directory(set.folder / "conf");
  set.save("conf/set.conf", "bmesh ../a.ply 0 0 0 0 0 0 1\n bmesh ./../sub/b.ply 0 0 0 0 0 0 1 \n");
  write_parts(set.folder / "out", *read(set.folder / "conf/set.conf"));
  EXPECT_EQ(set.text("out/set.conf"), "bmesh a.ply 0 0 0 0 0 0 1\n bmesh b.ply 0 0 0 0 0 0 1 \n");
  EXPECT_EQ(set.text("out/b.ply"), set.text("sub/b.ply"));
}

TEST(ScanSet, ASetMadeByAProgramIsWritten) {
  Shape shape;
  shape.positions = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  Part part;
  part.path = "one.ply";
  part.count = 1;
  shape.parts.push_back(part);
  part = {};
  part.path = "two.ply";
  part.first = 1;
  part.count = 2;
  part.rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  part.translation = Vec3(0.5, -2, 1);
  shape.parts.push_back(part);
  const TemporaryFolder folder;
  write_parts(folder.path().string(), shape);
  const auto again = read(folder / "scans.conf");
  ASSERT_EQ(again->size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR((point(*again, i) - shape.positions[i]).norm(), 0, 1e-6);
}

TEST(ScanSet, WrongFilesAreRefusedWithTheirPlace) {
  const SmallSet set;
  const std::string path = set.folder / "x.conf";
  const auto refused = [&](const std::string& text) {
    std::string sentence = refusal(read_scan_set, text, path);
    return sentence.starts_with(path) ? "x.conf" + sentence.substr(path.size()) : sentence;
  };
  EXPECT_EQ(refused("camera 1 2 3\n"), "x.conf: expected a line \"bmesh FILE tx ty tz qi qj qk qr\", found none");
  EXPECT_EQ(refused("bmesh\n"), "x.conf:1:6: expected the file of a scan, found the end of the line");
  EXPECT_EQ(refused("\n bmesh a.ply 0 0 q 0 0 0 1"),
            "x.conf:2:18: expected a number of the translation tx ty tz, found \"q\"");
  EXPECT_EQ(refused("bmesh a.ply 0 0 0 0 0 1"),
            "x.conf:1:24: expected a number of the rotation qi qj qk qr, found the end of the line");
  EXPECT_EQ(refused("bmesh a.ply 0 nan 0 0 0 0 1"),
            "x.conf:1:15: expected a number of the translation tx ty tz, found \"nan\"");
  EXPECT_EQ(refused("bmesh a.ply 0 0 0 0 0 0 1 2"), "x.conf:1:27: expected the end of the line after qr, found \"2\"");
  EXPECT_EQ(refused("bmesh a.ply 0 0 0 0 0 0 0"),
            "x.conf:1: expected a rotation qi qj qk qr of length 1, found the length 0");
  EXPECT_EQ(refused("bmesh no.ply 0 0 0 0 0 0 1"), "x.conf: expected a scan beside it, found none of \"no.ply\"");
  EXPECT_EQ(refused("bmesh set.conf 0 0 0 0 0 0 1"),
            "x.conf:1:7: expected a file of points, found another scan set, \"set.conf\"");
  set.save("pointer.ply", "version https://git-lfs.github.com/spec/v1\n");
  EXPECT_EQ(refused("bmesh pointer.ply 0 0 0 0 0 0 1"),
            (set.folder / "pointer.ply") +
                ": expected PLY data, found a Git LFS pointer (the file itself was not downloaded)");
  set.save("bad.ply", "plx\n");
  EXPECT_EQ(refused("bmesh bad.ply 0 0 0 0 0 0 1"), (set.folder / "bad.ply") + ":1:1: expected \"ply\", found \"plx\"");
}

TEST(ScanSet, TheSameNameTwiceCannotBeWritten) {
  const SmallSet set;
  set.save("set.conf", "bmesh a.ply 0 0 0 0 0 0 1\nbmesh a.ply 1 0 0 0 0 0 1\n");
  const auto shape = read(set.folder / "set.conf");
  try {
    write_parts(set.folder / "out", *shape);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "a.ply: expected another name for each scan to write, found it twice");
  }
}

TEST(ScanSet, ScansOfTheBunnyLieOnEachOther) {
  SHARED_DATA(path, "scans/stanford_bunny/bun.conf");
  const auto shape = read(path.string());
  ASSERT_EQ(shape->parts.size(), 4u);
  EXPECT_EQ(shape->size(), 40256u + 40097u + 30379u + 35336u);
  const auto points = [&](std::size_t i) {
    return std::span(shape->positions).subspan(shape->parts[i].first, shape->parts[i].count);
  };
  // Scans of neighbouring directions overlap by more than half; apart from the poses they are 0.015 from each other.
  EXPECT_LT(median_distance(points(1), points(0)), 0.0008);
  EXPECT_LT(median_distance(points(3), points(0)), 0.0008);
}

TEST(ScanSet, TheBunnyGoesBackToItsFiles) {
  SHARED_DATA(path, "scans/stanford_bunny/bun.conf");
  Shape shape = *read(path.string());
  const TemporaryFolder folder;
  write_parts(folder / "same", shape);
  for (const char* name : {"bun000.ply", "bun045.ply", "bun090.ply", "bun315.ply", "bun.conf"})
    EXPECT_TRUE(text_of_file(folder / ("same/" + std::string(name))) == text_of_file(path.parent_path() / name))
        << name;
  for (std::size_t i = 0; i < shape.size(); i += 3) shape.positions[i] += Vec3(0.01, 0.02, -0.01);
  write_parts(folder / "moved", shape);
  Shape again = *read(folder / "moved/bun.conf");
  ASSERT_EQ(again.size(), shape.size());
  for (std::size_t i = 0; i < shape.size(); ++i)
    ASSERT_LE((point(again, i) - point(shape, i)).norm(), i % 3 == 0 ? 3e-8 : 0) << i;
}

}  // namespace sinew::io
