#include "engine/io/marker_csv.h"
#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sinew::io::fuzz_motion(sinew::io::read_marker_csv, {data, size});
  return 0;
}
