#include "engine/io/off.h"
#include "tests/fuzz/fuzz_format.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sinew::io::fuzz_format(sinew::io::read_off, sinew::io::write_off, {data, size});
  return 0;
}
