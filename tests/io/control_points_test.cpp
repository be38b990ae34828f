/// CSV of control points.

#include "engine/io/control_points.h"

#include <fstream>

#include "engine/io/io.h"
#include "tests/io/motion_checks.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

class ControlPoints : public ::testing::Test {
 protected:
  std::vector<ControlPoint> read(const std::string& text) {
    std::ofstream(folder / "points.csv", std::ios::binary) << text;
    return read_control_points(folder / "points.csv");
  }
  std::string refused(const std::string& text) {
    const std::string sentence = sentence_of([&] { read(text); });
    return sentence.substr(sentence.find("points.csv") + 10);
  }
  bool known(const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
    return is_control_points(folder / name);
  }
  TemporaryFolder folder;
};

}  // namespace

TEST_F(ControlPoints, ColumnsByNameInAnyOrder) {
  const auto points = read(
      "\xef\xbb\xbftz;note;TX;ty;X;y;z;Name\r\n3;far;1;2;4;5;6;\"corner; west\"\r\n\r\n# "
      "later\r\n-1;;1e3;0;0;0;0;B\r\n");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].name, "corner; west");
  EXPECT_EQ(points[0].at, Vec3(4, 5, 6));
  EXPECT_EQ(points[0].to, Vec3(1, 2, 3));
  EXPECT_FALSE(points[0].point);
  EXPECT_EQ(points[1].to, Vec3(1000, 0, -1));

  const auto ids = read("id,tx,ty,tz\n7,1,2,3\n");
  ASSERT_EQ(ids.size(), 1u);
  EXPECT_EQ(ids[0].point, 7u);
  const auto both = read("id,x,y,z,tx,ty,tz\nGCP1,0,0,0,1,2,3\n");
  EXPECT_EQ(both[0].name, "GCP1") << "with a place the id is a name";
  EXPECT_FALSE(both[0].point);
}

TEST_F(ControlPoints, ColumnsByTheirNumber) {
  const auto ids = read("3,1,2,3\n4\t,5,6,7\n");
  ASSERT_EQ(ids.size(), 2u);
  EXPECT_EQ(ids[1].point, 4u);
  EXPECT_EQ(ids[1].to, Vec3(5, 6, 7));
  const auto places = read("# from the survey\n5400000.125\t2\t3\t4\t5\t6\n");
  EXPECT_EQ(places[0].at, Vec3(5400000.125, 2, 3));
  EXPECT_EQ(read("A, 1, 2, 3, 4, 5, 6")[0].name, "A");
}

TEST_F(ControlPoints, WhatIsWrongIsSaidWithItsPlace) {
  EXPECT_EQ(refused(""), ": expected at least one control point, found none");
  EXPECT_EQ(refused("tx,ty,tz,id\n"), ": expected at least one control point, found none");
  EXPECT_TRUE(refused("a,b,c\n").starts_with(":1:1: expected columns tx, ty and tz")) << refused("a,b,c\n");
  EXPECT_TRUE(refused("tx,ty,tz\n").starts_with(":1:1: expected columns x, y and z, or id")) << refused("tx,ty,tz\n");
  EXPECT_TRUE(refused("1,2,3\n").ends_with("found 3 columns")) << refused("1,2,3\n");
  EXPECT_EQ(refused("1,1,2,3\n2,1,2\n"), ":2:1: expected 4 columns, found 3");
  EXPECT_EQ(refused("1,1,2,3\n2,1,b,3\n"), ":2:5: expected a finite number, found \"b\"");
  EXPECT_EQ(refused("1,1,2,3\n2,1,nan,3\n"), ":2:5: expected a finite number, found \"nan\"");
  EXPECT_EQ(refused("1.5,1,2,3\n"), ":1:1: expected the number of a point, from 0, found \"1.5\"");
  EXPECT_EQ(refused("-1,1,2,3\n"), ":1:1: expected the number of a point, from 0, found \"-1\"");
  EXPECT_EQ(refused("id,tx,ty,tz\n4294967295,1,2,3\n"),
            ":2:1: expected the number of a point, from 0, found \"4294967295\"");
}

TEST_F(ControlPoints, OnlyNamesOfTargetsTellWhatAFileIs) {
  EXPECT_TRUE(known("a.csv", "id,tx,ty,tz\n1,0,0,0\n"));
  EXPECT_TRUE(known("a.CSV", "# survey\n\nname;x;y;z;target_x;target_y;target_z\n"));
  EXPECT_FALSE(known("a.csv", "1,2,3,4,5,6\n")) << "it could be points with normals";
  EXPECT_FALSE(known("a.csv", "x,y,z,nx,ny,nz\n"));
  EXPECT_FALSE(known("a.csv", "frame,time,A.x,A.y,A.z\n"));
  EXPECT_FALSE(known("a.txt", "id,tx,ty,tz\n"));
  EXPECT_FALSE(is_control_points(folder / "none.csv"));
}

}  // namespace sinew::io
