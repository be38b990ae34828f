#include "engine/io/gltf_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "engine/io/io.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

constexpr bool swap = std::endian::native != std::endian::little;

std::size_t size_of_component(int type) {
  switch (type) {
    case 5120:
    case 5121: return 1;
    case 5122:
    case 5123: return 2;
    case 5125:
    case 5126: return 4;
    default: return 0;
  }
}

std::size_t components_of(const JsonView& type) {
  static constexpr std::array<std::pair<const char*, std::size_t>, 7> types{
      {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
  for (const auto& [name, components] : types)
    if (type.text() == name) return components;
  throw type.error("SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4", sinew::quoted(type.text()));
}

/// One component; integers that are normalized become -1..1 or 0..1 (section 3.11).
double component(const std::byte* at, int type, bool normalized) {
  const auto integer = [normalized](double x, double most) { return normalized ? std::max(x / most, -1.0) : x; };
  switch (type) {
    case 5120: return integer(load<std::int8_t>(at, swap), 127);
    case 5121: return integer(load<std::uint8_t>(at, swap), 255);
    case 5122: return integer(load<std::int16_t>(at, swap), 32767);
    case 5123: return integer(load<std::uint16_t>(at, swap), 65535);
    case 5125: return load<std::uint32_t>(at, swap);
    default: return static_cast<double>(load<float>(at, swap));
  }
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// "%20" and such become their bytes.
std::string without_percent(std::string_view uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool code = uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0;
    out += code ? static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2])) : uri[i];
    if (code) i += 2;
  }
  return out;
}

std::vector<std::byte> from_base64(const JsonView& uri, std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::vector<std::byte> out;
  out.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t digit = digits.find(c);
    if (digit == std::string_view::npos) throw uri.error("base64", sinew::quoted(std::string_view(&c, 1)));
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out.push_back(static_cast<std::byte>(bits >> count & 255));
  }
  return out;
}

void refuse_compressed(const JsonView& root) {
  const std::optional<JsonView> required = root.find("extensionsRequired");
  for (std::size_t i = 0; required && i < required->size(); ++i)
    for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"})
      if (required->item(i).text() == name)
        throw required->item(i).error("geometry that is not compressed", sinew::quoted(name));
}

}  // namespace

GltfDocument::GltfDocument(const std::string& path, std::vector<std::byte> bytes)
    : path_(path), bytes_(std::move(bytes)) {
  refuse_lfs_pointer(path_, bytes_, "glTF");
  glb_ = as_text(bytes_).starts_with("glTF");
  std::string_view json = glb_ ? json_of_glb() : as_text(bytes_);
  if (json.starts_with("\xef\xbb\xbf")) json.remove_prefix(3);
  root_ = parse_json(path_, json);
  const JsonView version = root().member("asset").member("version");
  if (!version.text().starts_with("2.")) throw version.error("2.0", sinew::quoted(version.text()));
  refuse_compressed(root());
  total_size_ = bytes_.size();
  const std::size_t buffers = root().size_of("buffers");
  for (std::size_t i = 0; i < buffers; ++i) {
    buffers_.push_back(load_buffer(root().member("buffers").item(i), i == 0));
    total_size_ += buffers_.back().size();
  }
}

/// Section 4.4: a header of 12 bytes and chunks, JSON first and then BIN.
std::string_view GltfDocument::json_of_glb() {
  ByteCursor cursor(path_, bytes_, 4);
  const auto version = cursor.number<std::uint32_t>(false, "the version");
  if (version != 2) throw byte_error(path_, 4, "version 2", std::to_string(version));
  const auto length = cursor.number<std::uint32_t>(false, "the length");
  if (length > bytes_.size())
    throw byte_error(path_, 8, std::to_string(length) + " bytes", "only " + std::to_string(bytes_.size()));
  const auto chunk = [&](std::string_view type, const char* what) {
    const std::size_t at = cursor.at();
    const auto size = cursor.number<std::uint32_t>(false, "the length of a chunk");
    const std::span<const std::byte> name = cursor.take(4, "the type of a chunk");
    if (as_text(name) != type)
      throw byte_error(path_, static_cast<std::int64_t>(at) + 4, std::string("the chunk ") + what,
                       sinew::quoted(as_text(name)));
    return cursor.take(size, std::string("the chunk ") + what);
  };
  const std::span<const std::byte> json = chunk("JSON", "JSON");
  if (cursor.left() >= 8 && cursor.at() < length) binary_ = chunk(std::string_view("BIN\0", 4), "BIN");
  return as_text(json);
}

std::vector<std::byte> GltfDocument::load_buffer(const JsonView& buffer, bool first) {
  const std::size_t length = buffer.member("byteLength").count();
  std::vector<std::byte> bytes;
  const std::optional<JsonView> uri = buffer.find("uri");
  if (!uri) {
    if (!first || !glb_) throw buffer.error("a member \"uri\"", "none");
    bytes.assign(binary_.begin(), binary_.end());
  } else if (const std::string& text = uri->text(); text.starts_with("data:")) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos || !std::string_view(text).substr(0, comma).ends_with(";base64"))
      throw uri->error("data in base64", sinew::quoted(text));
    bytes = from_base64(*uri, std::string_view(text).substr(comma + 1));
  } else {
    self_contained_ = false;
    const std::string name = without_percent(text);
    if (text.find("://") != std::string::npos) throw uri->error("a file beside it", sinew::quoted(text));
    const std::filesystem::path file = std::filesystem::path(path_).parent_path() / name;
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none))
      throw uri->error("a file beside it", "no " + sinew::quoted(name));
    bytes = load_bytes(file.string());
  }
  if (bytes.size() < length)
    throw buffer.error(std::to_string(length) + " bytes", "only " + std::to_string(bytes.size()));
  bytes.resize(length);
  return bytes;
}

JsonView GltfDocument::object(const char* array, const JsonView& index) const {
  const std::optional<JsonView> items = root().find(array);
  const std::size_t i = index.index(items ? items->size() : 0);
  return items->item(i);
}

std::span<const std::byte> GltfDocument::view_bytes(const JsonView& view) const {
  const std::vector<std::byte>& buffer = buffers_[view.member("buffer").index(buffers_.size())];
  const std::size_t offset = view.count_or("byteOffset", 0), length = view.member("byteLength").count();
  if (offset > buffer.size() || length > buffer.size() - offset)
    throw view.error("bytes within its buffer of " + std::to_string(buffer.size()),
                     std::to_string(length) + " from " + std::to_string(offset) + " on");
  return std::span(buffer).subspan(offset, length);
}

/// `count` elements of `element` bytes that `where` has in its bufferView, named `view`.
GltfDocument::Elements GltfDocument::elements(const JsonView& where, const char* view, std::size_t count,
                                              std::size_t element) const {
  const std::optional<JsonView> index = where.find(view);
  if (!index) {
    if (count > total_size_)
      throw where.error("no more elements than the file has bytes, " + std::to_string(total_size_),
                        std::to_string(count));
    return {};
  }
  const JsonView buffer_view = object("bufferViews", *index);
  const std::span<const std::byte> bytes = view_bytes(buffer_view);
  const std::size_t offset = where.count_or("byteOffset", 0);
  std::size_t stride = buffer_view.count_or("byteStride", 0);
  if (stride != 0 && stride < element)
    throw buffer_view.error("a byteStride of at least " + std::to_string(element), std::to_string(stride));
  if (stride == 0) stride = element;
  const std::size_t left = offset < bytes.size() ? bytes.size() - offset : 0;
  if (count > 0 && (left < element || count - 1 > (left - element) / stride))
    throw where.error(std::to_string(count) + " elements of " + std::to_string(element) + " bytes",
                      "only " + std::to_string(left) + " bytes of its bufferView");
  return {bytes.data() + std::min(offset, bytes.size()), stride};
}

GltfDocument::Accessor GltfDocument::accessor(const JsonView& index) const {
  const JsonView object = this->object("accessors", index);
  Accessor out;
  out.count = object.member("count").count(0xfffffffe);
  out.components = components_of(object.member("type"));
  const JsonView type = object.member("componentType");
  out.component_type = static_cast<int>(type.count(65535));
  if (size_of_component(out.component_type) == 0)
    throw type.error("a component type of 5120 to 5126", std::to_string(out.component_type));
  const std::optional<JsonView> normalized = object.find("normalized");
  out.normalized = normalized && out.component_type < 5125 && normalized->truth();
  elements(object, "bufferView", out.count, out.components * size_of_component(out.component_type));
  return out;
}

std::vector<double> GltfDocument::numbers(const JsonView& index, std::size_t components) const {
  const JsonView object = this->object("accessors", index);
  const Accessor a = accessor(index);
  if (a.components != components)
    throw object.error(std::to_string(components) + " components", std::to_string(a.components));
  const std::size_t size = size_of_component(a.component_type);
  const Elements from = elements(object, "bufferView", a.count, components * size);
  std::vector<double> out(a.count * components, 0.0);
  for (std::size_t i = 0; from.begin != nullptr && i < a.count; ++i)
    for (std::size_t c = 0; c < components; ++c)
      out[i * components + c] = component(from.begin + i * from.stride + c * size, a.component_type, a.normalized);
  if (const std::optional<JsonView> sparse = object.find("sparse")) replace_sparse(*sparse, a, out);
  return out;
}

/// Section 3.6.2.3: ascending indices, and the values that stand there.
void GltfDocument::replace_sparse(const JsonView& sparse, const Accessor& a, std::vector<double>& numbers) const {
  const std::size_t count = sparse.member("count").count(a.count);
  const JsonView indices = sparse.member("indices"), values = sparse.member("values");
  indices.member("bufferView");
  values.member("bufferView");
  const JsonView type = indices.member("componentType");
  const auto index_type = static_cast<int>(type.count(65535));
  if (index_type != 5121 && index_type != 5123 && index_type != 5125)
    throw type.error("5121, 5123 or 5125", std::to_string(index_type));
  const std::size_t size = size_of_component(a.component_type);
  const Elements at = elements(indices, "bufferView", count, size_of_component(index_type));
  const Elements from = elements(values, "bufferView", count, a.components * size);
  for (std::size_t i = 0; i < count; ++i) {
    const auto where = static_cast<std::size_t>(component(at.begin + i * at.stride, index_type, false));
    if (where >= a.count) throw indices.error("indices below " + std::to_string(a.count), std::to_string(where));
    for (std::size_t c = 0; c < a.components; ++c)
      numbers[where * a.components + c] =
          component(from.begin + i * from.stride + c * size, a.component_type, a.normalized);
  }
}

}  // namespace sinew::io
