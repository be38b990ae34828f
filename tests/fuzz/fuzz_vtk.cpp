#include "engine/io/vtk.h"
#include "tests/fuzz/fuzz_format.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sinew::io::fuzz_format(sinew::io::read_vtk, sinew::io::write_vtk, {data, size});
  return 0;
}
