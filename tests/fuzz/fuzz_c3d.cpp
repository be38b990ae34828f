#include "engine/io/c3d.h"
#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sinew::io::fuzz_motion(sinew::io::read_c3d, {data, size});
  return 0;
}
