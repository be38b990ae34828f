#include <algorithm>
#include <cmath>

#include "engine/io/ply.h"
#include "engine/io/ply_content.h"
#include "engine/io/ply_generic.h"
#include "engine/io/ply_values.h"

namespace sinew::io {

namespace {

constexpr std::size_t chunk_rows = 1 << 14;

bool same_kind(const Attribute& a, const Attribute& b) {
  return a.name == b.name && a.fields == b.fields && a.kind == b.kind && a.type == b.type &&
         a.components == b.components && a.per_point() == b.per_point();
}

/// The file's bytes can still hold the shape.
bool fits(const PlyContent& content, const Shape& shape) {
  const auto& attributes = content.layout.attributes;
  return shape.size() == content.header.vertices().count && shape.position_type == content.layout.position_type &&
         std::equal(attributes.begin(), attributes.end(), shape.attributes.begin(), shape.attributes.end(),
                    same_kind) &&
         fingerprint(shape.faces) == content.faces;
}

/// Where a value stands in the file.
struct Span {
  std::size_t begin = 0, size = 0;
};

/// Walks the points of a file whose rows have no fixed size. For each value that differs calls
/// replace(span, column, value in this machine's byte order), in the order of the file.
template <class Values, class Replace>
void for_changes(const PlyContent& content, const Shape& shape, Values& values, const Replace& replace) {
  const PlyElement& element = content.header.vertices();
  PlyVertices layout = content.layout;
  layout.swap = false;
  const std::size_t columns = layout.columns.size();
  std::vector<std::byte> before, now;
  std::vector<Span> spans;
  values.begin_element(element);
  for (std::size_t first = 0; first < shape.size(); first += chunk_rows) {
    const std::size_t count = std::min(chunk_rows, shape.size() - first);
    before.resize(count * layout.stride);
    spans.resize(count * columns);
    for (std::size_t i = 0; i < count; ++i) {
      values.begin_row(first + i);
      read_packed(values, element, before.data() + i * layout.stride,
                  [&](std::size_t column, std::size_t begin, std::size_t size) {
                    spans[i * columns + column] = {begin, size};
                  });
      values.end_row();
    }
    now = before;
    patch_rows(layout, shape, first, now);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < columns; ++c) {
        const std::size_t at = i * layout.stride + layout.columns[c].offset, size = size_of(layout.columns[c].type);
        if (layout.columns[c].attribute != PlyColumn::unused && std::memcmp(&before[at], &now[at], size) != 0)
          replace(spans[i * columns + c], layout.columns[c], &now[at]);
      }
  }
}

std::string to_text(const PlyVertices& layout, const PlyColumn& column, const std::byte* value) {
  if (column.attribute == PlyColumn::position && layout.narrow)
    return shortest(static_cast<float>(load<double>(value, false)));
  return with_type(column.type, [value](auto t) {
    const auto x = load<decltype(t)>(value, false);
    if constexpr (std::is_integral_v<decltype(t)>) {
      return std::to_string(x);
    } else {
      return shortest(x);
    }
  });
}

std::vector<std::byte> patched_text(const std::string& path, const PlyContent& content, const Shape& shape) {
  const std::string_view text = as_text(content.bytes);
  std::vector<std::byte> out;
  out.reserve(text.size() + text.size() / 8);
  std::size_t copied = 0;
  const auto copy_to = [&](std::size_t end) {
    out.insert(out.end(), content.bytes.begin() + static_cast<std::ptrdiff_t>(copied),
               content.bytes.begin() + static_cast<std::ptrdiff_t>(end));
  };
  PlyText values(path, text, content.vertices_at, content.vertices_line);
  for_changes(content, shape, values, [&](Span span, const PlyColumn& column, const std::byte* value) {
    copy_to(span.begin);
    const std::string number = to_text(content.layout, column, value);
    const auto* begin = reinterpret_cast<const std::byte*>(number.data());
    out.insert(out.end(), begin, begin + number.size());
    copied = span.begin + span.size;
  });
  copy_to(text.size());
  return out;
}

std::vector<std::byte> patched(const std::string& path, const PlyContent& content, const Shape& shape) {
  if (content.header.encoding == PlyEncoding::Ascii) return patched_text(path, content, shape);
  std::vector<std::byte> out = content.bytes;
  if (!content.header.vertices().has_list()) {
    const std::size_t size = shape.size() * content.layout.stride;
    patch_rows(content.layout, shape, 0, std::span(out).subspan(content.vertices_at, size));
    return out;
  }
  const bool swap = content.header.swap();
  PlyBinary values(path, content.bytes, content.vertices_at, swap);
  for_changes(content, shape, values, [&](Span span, const PlyColumn&, const std::byte* value) {
    std::byte* at = out.data() + span.begin;
    std::memcpy(at, value, span.size);
    if (swap) std::reverse(at, at + span.size);
  });
  return out;
}

/// What of a PLY file is not carried over where its points or attributes are not the same ones any more.
void report_content(const PlyContent& content, WriteReport& report) {
  for (const PlyElement& element : content.header.elements)
    if (element.name != "vertex" && element.name != "face" && element.count > 0)
      report.lost.push_back("The element " + quoted(element.name) +
                            " is not written: the points, attributes or faces are no longer those of the file.");
  if (content.header.comments > 0)
    report.lost.push_back(std::to_string(content.header.comments) + " comments are not written.");
}

}  // namespace

std::vector<std::byte> write_ply(const std::string& path, const Shape& shape, WriteReport& report) {
  if (const auto* content = dynamic_cast<const PlyContent*>(shape.content.get()); content != nullptr) {
    if (fits(*content, shape)) return patched(path, *content, shape);
    report_content(*content, report);
  }
  return new_ply(shape, report);
}

}  // namespace sinew::io
