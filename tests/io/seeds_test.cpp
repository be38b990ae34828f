#include <filesystem>
#include <iostream>

#include "engine/io/bgeo.h"
#include "engine/io/bvh.h"
#include "engine/io/c3d.h"
#include "engine/io/gmsh.h"
#include "engine/io/medit.h"
#include "engine/io/obj.h"
#include "engine/io/off.h"
#include "engine/io/pcd.h"
#include "engine/io/trc.h"
#include "engine/io/vtk.h"
#include "engine/io/xyz.h"
#include "tests/fuzz/targets.h"
#include "tests/io/file_checks.h"

namespace sinew::io {

namespace {

/// A folder of tests/fuzz/seeds and what its fuzz target does.
struct Target {
  const char* name;
  void (*fuzz)(std::span<const std::uint8_t> data);
};

template <ReadFunction read, WriteFunction write>
void fuzz(std::span<const std::uint8_t> data) {
  fuzz_format(read, write, data);
}

template <Trajectories (*read)(const std::string&, std::span<const std::byte>)>
void fuzz(std::span<const std::uint8_t> data) {
  fuzz_motion(read, data);
}

class Seeds : public testing::TestWithParam<Target> {};

}  // namespace

/// A CHECK of the target ends the program: the last name that was printed is that of the seed.
TEST_P(Seeds, EndInAShapeOrASentence) {
  std::size_t count = 0;
  const auto folder = std::filesystem::path(SINEW_SOURCE_DIR) / "tests/fuzz/seeds" / GetParam().name;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::cout << entry.path().string() << std::endl;
    const std::string text = text_of_file(entry.path().string());
    GetParam().fuzz({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    ++count;
  }
  EXPECT_GT(count, 4u);
}

INSTANTIATE_TEST_SUITE_P(
    Formats, Seeds,
    testing::Values(Target{"ply", fuzz_ply}, Target{"stl", fuzz_stl}, Target{"conf", fuzz_scan_set},
                    Target{"obj", fuzz<read_obj, write_obj>}, Target{"off", fuzz<read_off, write_off>},
                    Target{"xyz", fuzz<read_xyz, write_xyz>}, Target{"csv", fuzz<read_csv, write_csv>},
                    Target{"pc2", fuzz_pc2}, Target{"mdd", fuzz_mdd}, Target{"gltf", fuzz_gltf},
                    Target{"pcd", fuzz<read_pcd, write_pcd>}, Target{"vtp", fuzz_vtp},
                    Target{"bgeo", fuzz<read_bgeo, write_bgeo>}, Target{"vtk", fuzz<read_vtk, write_vtk>},
                    Target{"tetgen", fuzz_tetgen}, Target{"gmsh", fuzz<read_gmsh, write_gmsh>},
                    Target{"medit", fuzz<read_medit, write_medit>}, Target{"c3d", fuzz<read_c3d>},
                    Target{"trc", fuzz<read_trc>}, Target{"bvh", fuzz<read_bvh>},
                    Target{"markers", fuzz<read_marker_csv>}, Target{"control", fuzz_control}));

}  // namespace sinew::io
