#pragma once
/// The real splash of the shared data: the Points of an ASCII USD file as a shape, for tests only.

#include <charconv>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/geometry/error.h"
#include "engine/io/io.h"

namespace sinew {

/// The numbers between the brackets of `NAME.timeSamples = { FRAME: [...] }` or `NAME = [...]`.
inline std::vector<double> usda_numbers(const std::string& text, const std::string& name) {
  const std::size_t at = text.find(" " + name + ".timeSamples = "), still = text.find(" " + name + " = ");
  const std::size_t open = text.find('[', at != std::string::npos ? text.find(':', text.find('{', at)) : still);
  if ((at == std::string::npos && still == std::string::npos) || open == std::string::npos) return {};
  const std::size_t close = text.find(']', open);
  std::vector<double> numbers;
  for (const char* c = text.data() + open; c < text.data() + close;) {
    double x = 0;
    const auto [end, error] = std::from_chars(c, text.data() + close, x);
    if (error == std::errc{}) numbers.push_back(x);
    c = error == std::errc{} ? end : c + 1;
  }
  return numbers;
}

/// Points, "velocity" (units a second), "id" and "width" of a file such as
/// particles/usd_splash/Particles_Splash.101.usd, in the coordinates of its Points (xformOp:transform, the same in
/// every frame, is left out). Sets the origin. Throws InputError where there are no points or the arrays differ in
/// length.
inline std::shared_ptr<const Shape> read_usda_points(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = io::load_bytes(path.string());
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::vector<double> points = usda_numbers(text, "points");
  const std::size_t n = points.size() / 3;
  auto shape = std::make_shared<Shape>();
  for (std::size_t i = 0; i < n; ++i)
    shape->positions.emplace_back(static_cast<float>(points[3 * i]), static_cast<float>(points[3 * i + 1]),
                                  static_cast<float>(points[3 * i + 2]));
  const auto add = [&](const char* usd, const char* name, std::vector<std::string> fields, Kind kind, Type type) {
    const std::vector<double> numbers = usda_numbers(text, usd);
    if (n == 0 || points.size() != 3 * n || numbers.size() != n * fields.size())
      throw file_error(path.string(), std::string(usd) + " of every point",
                       std::to_string(numbers.size()) + " numbers");
    Attribute attribute;
    attribute.name = name;
    attribute.components = static_cast<int>(fields.size());
    attribute.fields = std::move(fields);
    attribute.kind = kind;
    attribute.type = type;
    attribute.values.resize(n * attribute.row_size());
    for (std::size_t k = 0; k < numbers.size(); ++k)
      attribute.set_number(k / static_cast<std::size_t>(attribute.components),
                           static_cast<int>(k % static_cast<std::size_t>(attribute.components)), numbers[k]);
    shape->attributes.push_back(std::move(attribute));
  };
  add("velocities", "velocity", {"vx", "vy", "vz"}, Kind::Velocity, Type::Float32);
  add("primvars:id", "id", {"id"}, Kind::Id, Type::Int32);
  add("widths", "width", {"width"}, Kind::Scalar, Type::Float32);
  set_origin(*shape);
  return shape;
}

}  // namespace sinew
