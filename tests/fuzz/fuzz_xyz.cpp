#include "engine/io/xyz.h"
#include "tests/fuzz/fuzz_format.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sinew::io::fuzz_format(sinew::io::read_xyz, sinew::io::write_xyz, {data, size});
  return 0;
}
