#include "engine/io/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace sinew::io {

TEST(Parse, TakesNumbersAsFilesWriteThem) {
  const std::pair<const char*, double> good[] = {{"1", 1},
                                                 {"+2.5", 2.5},
                                                 {"-0", -0.0},
                                                 {".5", 0.5},
                                                 {"5.", 5},
                                                 {"1e3", 1000},
                                                 {"-1.25E-2", -0.0125},
                                                 {"1e-400", 0},
                                                 {"0.0000000000000000000000000001e-310", 0}};
  for (const auto& [text, value] : good) {
    double x = 7;
    EXPECT_TRUE(parse(text, x)) << text;
    EXPECT_EQ(x, value) << text;
  }
  double x = 0;
  EXPECT_TRUE(parse("nan", x) && std::isnan(x));
  EXPECT_TRUE(parse("-INF", x) && std::isinf(x));
}

TEST(Parse, RefusesTheRest) {
  double x = 0;
  for (const char* text : {"", "+", "-", "1x", "1 ", " 1", "1,5", "++1", "+-1", "0x10", "1.#IND", "1e", "e5", "1e400",
                           "-1e400", "1e99999999999999999999"})
    EXPECT_FALSE(parse(text, x)) << text;
  // A number that is large although its exponent is negative, and one that is small although its exponent is not.
  EXPECT_FALSE(parse("1" + std::string(400, '0') + "e-5", x));
  EXPECT_TRUE(parse("0." + std::string(400, '0') + "1e5", x));
  EXPECT_EQ(x, 0);
  std::int64_t n = 0;
  EXPECT_TRUE(parse("+12", n));
  EXPECT_EQ(n, 12);
  for (const char* text : {"", "1.0", "9223372036854775808", "1e3", "--1"}) EXPECT_FALSE(parse(text, n)) << text;
}

TEST(Shortest, ReadsBackAsTheSameNumber) {
  for (const double value : {0.1, 1.0 / 3, 5400000.001, -1e-300, 123456789.0}) {
    double x = 0;
    EXPECT_TRUE(parse(shortest(value), x));
    EXPECT_EQ(x, value);
    float f = 0;
    EXPECT_TRUE(parse(shortest(static_cast<float>(value)), f));
    EXPECT_EQ(f, static_cast<float>(value));
  }
  EXPECT_EQ(shortest(0.1F), "0.1");
}

}  // namespace sinew::io
