#pragma once
/// CHECK(condition, value...): our own bugs end the program at once, with the values that show why. Always on: a crash
/// beside an autosave is cheaper than a silent wrong result. Bad input is not a bug: see error.h.

#include <cstdio>
#include <cstdlib>
#include <iostream>

namespace sinew {

template <class... Values>
[[noreturn]] void check_failed(const char* condition, const char* file, int line, const Values&... values) {
  std::cerr << file << ':' << line << ": CHECK(" << condition << ") failed";
  ((std::cerr << "  " << values), ...);
  std::cerr << std::endl;
  std::abort();
}

}  // namespace sinew

#define CHECK(condition, ...)                                                                           \
  do {                                                                                                  \
    if (!(condition)) ::sinew::check_failed(#condition, __FILE__, __LINE__ __VA_OPT__(, ) __VA_ARGS__); \
  } while (false)
