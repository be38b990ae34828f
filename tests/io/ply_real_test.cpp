#include "engine/io/ply.h"
#include "tests/io/file_checks.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

/// Real PLY files and what is known of them.
struct RealFile {
  const char* name;
  std::size_t points, faces;
};

class RealPly : public testing::TestWithParam<RealFile> {};

/// Damaged files, and what is said of them behind the path.
struct DamagedFile {
  const char* name;
  const char* sentence;
};

class DamagedPly : public testing::TestWithParam<DamagedFile> {};

}  // namespace

TEST_P(RealPly, ComesBackByteForByte) {
  SHARED_DATA(path, GetParam().name);
  const auto shape = read(path.string());
  EXPECT_EQ(shape->size(), GetParam().points);
  EXPECT_EQ(shape->faces.size(), GetParam().faces);
  EXPECT_TRUE(write_text(write_ply, *shape) == text_of_file(path.string()));
  EXPECT_TRUE(lost(write_ply, *shape).empty());
}

TEST_P(DamagedPly, IsRefusedInOneSentence) {
  SHARED_DATA(path, GetParam().name);
  try {
    read(path.string());
    ADD_FAILURE() << "read";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), path.string() + GetParam().sentence);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shared, DamagedPly,
    testing::Values(
        DamagedFile{"malformed/assimp/empty.ply", ":1:1: expected \"ply\", found an empty file"},
        DamagedFile{
            "malformed/assimp/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply",
            ":7:10: expected a type (char, uchar, short, ushort, int, uint, float, double), found \"\\x00\\x00\\x00\""},
        DamagedFile{
            "malformed/assimp/issue623.ply",
            ":14:56: expected vertex_indices of vertex 0, a whole number from 0 to 255, found the end of the line"},
        DamagedFile{"malformed/trimesh/ply_empty_header.ply",
                    ":3: expected an element \"vertex\" before it, found none"},
        DamagedFile{"malformed/git_lfs_pointer/point_cloud.ply",
                    ": expected PLY data, found a Git LFS pointer (the file itself was not downloaded)"},
        DamagedFile{"splats/guitar.compressed.ply",
                    ":28: expected a property x of the points, found \"packed_position\", \"packed_rotation\", "
                    "\"packed_scale\", \"packed_color\""}));

INSTANTIATE_TEST_SUITE_P(
    Shared, RealPly,
    testing::Values(
        RealFile{"meshes/bun_zipper_res2.ply", 8171, 16301}, RealFile{"meshes/elephant.ply", 19753, 39290},
        RealFile{"meshes/icosahedron_ascii.ply", 12, 20}, RealFile{"meshes/sofa_ascii.ply", 12103, 24104},
        RealFile{"scans/meshlab_rangemaps/lato000.ply", 44461, 86766},
        RealFile{"scans/stanford_bunny/bun000.ply", 40256, 0}, RealFile{"scans/stanford_bunny/bun045.ply", 40097, 0},
        RealFile{"scans/stanford_bunny/bun090.ply", 30379, 0}, RealFile{"scans/stanford_bunny/bun315.ply", 35336, 0},
        RealFile{"soups/cube_with_fold.ply", 26, 48}, RealFile{"soups/many_small_holes.ply", 2004, 3524},
        RealFile{"soups/non_manif_hole.ply", 432, 755}, RealFile{"soups/two-boxes-bad-self-union.ply", 486, 708},
        RealFile{"splats/inria_format/point_cloud.ply", 9080, 0},
        RealFile{"splats/tiny_fixtures/minimal_ascii.ply", 3, 0}, RealFile{"malformed/trimesh/empty.ply", 0, 0},
        RealFile{"malformed/trimesh/ply_empty_ascii.ply", 0, 0},
        RealFile{"malformed/trimesh/ply_points_bin.ply", 8, 0}));

}  // namespace sinew::io
