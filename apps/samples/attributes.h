#pragma once
/// Attributes of the samples.

#include <string>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::samples {

/// `count` rows of zeros, a component for each field.
inline Attribute make_attribute(const char* name, std::vector<std::string> fields, Kind kind, Type type,
                                std::size_t count) {
  Attribute attribute;
  attribute.name = name;
  attribute.components = static_cast<int>(fields.size());
  attribute.fields = std::move(fields);
  attribute.kind = kind;
  attribute.type = type;
  attribute.values.resize(count * attribute.row_size());
  return attribute;
}

}  // namespace sinew::samples
