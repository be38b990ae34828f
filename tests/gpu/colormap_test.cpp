#include "engine/gpu/colormap.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sinew::gpu {

namespace {

void expect_near(PointColor color, int r, int g, int b, int by) {
  EXPECT_NEAR(color.r, r, by);
  EXPECT_NEAR(color.g, g, by);
  EXPECT_NEAR(color.b, b, by);
}

/// CIE lightness of an sRGB colour, 0..100.
double lightness(PointColor color) {
  const auto linear = [](int c) {
    const double x = c / 255.0;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  };
  const double y = 0.2126 * linear(color.r) + 0.7152 * linear(color.g) + 0.0722 * linear(color.b);
  return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

}  // namespace

TEST(Colormap, ViridisGetsLighterAllTheWay) {
  expect_near(color_at(Colormap::Viridis, 0), 68, 1, 84, 0);
  expect_near(color_at(Colormap::Viridis, 1), 253, 231, 37, 0);
  for (int i = 0; i < 100; ++i)
    EXPECT_LT(lightness(color_at(Colormap::Viridis, 0.01 * i)), lightness(color_at(Colormap::Viridis, 0.01 * (i + 1))));
}

// The colours of the article's table of 33 rows [Moreland 2009].
TEST(Colormap, CoolWarmIsThatOfItsArticle) {
  expect_near(color_at(Colormap::CoolWarm, 0), 59, 76, 192, 1);
  expect_near(color_at(Colormap::CoolWarm, 0.25), 141, 176, 254, 1);
  expect_near(color_at(Colormap::CoolWarm, 0.5), 221, 221, 221, 1);
  expect_near(color_at(Colormap::CoolWarm, 0.75), 244, 152, 122, 2);
  expect_near(color_at(Colormap::CoolWarm, 1), 180, 4, 38, 1);
}

TEST(Colormap, CoolWarmIsAsLightOnBothSides) {
  for (int i = 0; i <= 50; ++i)
    EXPECT_NEAR(lightness(color_at(Colormap::CoolWarm, 0.01 * i)),
                lightness(color_at(Colormap::CoolWarm, 1 - 0.01 * i)), 1.5);
}

TEST(Colormap, TurboGoesFromBlueOverGreenToRed) {
  const PointColor blue = color_at(Colormap::Turbo, 0.12), green = color_at(Colormap::Turbo, 0.5),
                   red = color_at(Colormap::Turbo, 0.9);
  EXPECT_GT(blue.b, blue.r + 60);
  EXPECT_GT(green.g, green.b + 100);
  EXPECT_GT(red.r, red.g + 100);
  EXPECT_GT(lightness(green), lightness(blue) + 30);
  EXPECT_GT(lightness(green), lightness(red) + 30);
}

TEST(Colormap, ValuesBeyondTheEndsHaveTheirColour) {
  for (const Colormap map : {Colormap::Viridis, Colormap::Turbo, Colormap::CoolWarm}) {
    const PointColor low = color_at(map, -3), first = color_at(map, 0);
    EXPECT_EQ(low.r, first.r);
    EXPECT_EQ(low.b, first.b);
    EXPECT_EQ(color_at(map, 7).r, color_at(map, 1).r);
  }
  EXPECT_EQ(colormap_named("cool-warm"), Colormap::CoolWarm);
  EXPECT_FALSE(colormap_named("jet"));
}

}  // namespace sinew::gpu
