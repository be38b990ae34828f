#include "engine/io/obj.h"
#include "tests/fuzz/fuzz_format.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sinew::io::fuzz_format(sinew::io::read_obj, sinew::io::write_obj, {data, size});
  return 0;
}
