#include "engine/io/gmsh.h"
#include "tests/fuzz/fuzz_format.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sinew::io::fuzz_format(sinew::io::read_gmsh, sinew::io::write_gmsh, {data, size});
  return 0;
}
