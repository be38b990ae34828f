#include "engine/io/medit.h"
#include "tests/fuzz/fuzz_format.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sinew::io::fuzz_format(sinew::io::read_medit, sinew::io::write_medit, {data, size});
  return 0;
}
