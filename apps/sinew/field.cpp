#include "apps/sinew/field.h"

#include <cmath>

#include "apps/sinew/command.h"
#include "engine/geometry/error.h"

namespace sinew::app {

namespace {

std::string expected_names(const Shape& shape) {
  std::string out;
  for (const document::FieldKind kind : {document::FieldKind::Displacement, document::FieldKind::Stretch,
                                         document::FieldKind::Rotation, document::FieldKind::Energy})
    out += std::string(document::field_names[static_cast<std::size_t>(kind)]) + ", ";
  for (const Attribute& attribute : shape.attributes)
    if (document::field_of(shape, attribute.name)) out += attribute.name + ", ";
  return out.substr(0, out.size() - 2);
}

document::Field values_of(const std::string& name, const Shape& rest, const Shape& shape,
                          const document::Evaluation* evaluation) {
  if (std::optional<document::Field> attribute = document::field_of(shape, name)) return std::move(*attribute);
  const std::optional<document::FieldKind> kind = document::field_named(name);
  if (!kind || *kind == document::FieldKind::Influence)
    throw UsageError("--color: expected one of " + expected_names(shape) + ", found " + sinew::quoted(name));
  if (evaluation == nullptr) throw UsageError("--color " + name + ": expected an edit (--edit), found none");
  return document::field_of(*kind, rest.positions, evaluation->layers);
}

}  // namespace

Field field_of(const FieldOptions& options, const Shape& rest, const Shape& shape,
               const document::Evaluation* evaluation) {
  Field out;
  out.map = options.map;
  out.field = values_of(options.name, rest, shape, evaluation);
  const bool around_zero = options.map == gpu::Colormap::CoolWarm;
  out.range = options.range ? *options.range : document::usual_range(out.field.values, out.field.scale, around_zero);
  const document::ValueRange extent = document::extent_of(out.field.values);
  out.most = -extent.low > extent.high ? extent.low : extent.high;
  return out;
}

gpu::PointColor color_of(const Field& field, double value) {
  if (!std::isfinite(value)) return {};
  const double span = field.range.high - field.range.low;
  return gpu::color_at(field.map, span > 0 ? (value - field.range.low) / span : 0);
}

}  // namespace sinew::app
