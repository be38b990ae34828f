#include "engine/io/gltf_builder.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/geometry/error.h"
#include "engine/io/text.h"
#include "engine/io/values.h"

namespace sinew::io {

namespace {

constexpr bool swap = std::endian::native != std::endian::little;

void put(std::vector<std::byte>& out, std::uint32_t x) {
  out.resize(out.size() + sizeof(x));
  store(out.data() + out.size() - sizeof(x), x, swap);
}
void put(std::vector<std::byte>& out, float x) {
  put(out, std::bit_cast<std::uint32_t>(x));
}
void put_text(std::vector<std::byte>& out, std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

std::string base64(std::span<const std::byte> bytes) {
  static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<std::uint32_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return out;
}

std::string list_of(const std::vector<float>& numbers) {
  std::string text;
  for (const float x : numbers) text += (text.empty() ? "" : ",") + shortest(static_cast<double>(x));
  return text;
}

}  // namespace

std::size_t GltfBuilder::begin_view(const std::string& rest) {
  views_.push_back({buffer_.size(), rest});
  return views_.size() - 1;
}

std::size_t GltfBuilder::add_floats(std::span<const float> values, std::size_t components) {
  const std::size_t offset = buffer_.size() - views_.back().begin;
  std::vector<float> min(components, std::numeric_limits<float>::infinity()), max(components, -min[0]);
  for (std::size_t i = 0; i < values.size(); ++i) {
    put(buffer_, values[i]);
    min[i % components] = std::min(min[i % components], values[i]);
    max[i % components] = std::max(max[i % components], values[i]);
  }
  accessors_.push_back(fmt::format(
      R"({{"bufferView":{},"byteOffset":{},"componentType":5126,"count":{},"type":"{}","min":[{}],"max":[{}]}})",
      views_.size() - 1, offset, values.size() / components, components == 3 ? "VEC3" : "SCALAR", list_of(min),
      list_of(max)));
  return accessors_.size() - 1;
}

std::size_t GltfBuilder::add_indices(std::span<const Index> indices) {
  const std::size_t offset = buffer_.size() - views_.back().begin;
  for (const Index index : indices) put(buffer_, index);
  accessors_.push_back(
      fmt::format(R"({{"bufferView":{},"byteOffset":{},"componentType":5125,"count":{},"type":"SCALAR"}})",
                  views_.size() - 1, offset, indices.size()));
  return accessors_.size() - 1;
}

std::vector<std::byte> GltfBuilder::finish(const std::string& path, const std::string& objects,
                                           GltfContainer container) const {
  std::string json = R"({"asset":{"version":"2.0","generator":"Sinew"},)" + objects + ",\n\"accessors\":[";
  for (std::size_t i = 0; i < accessors_.size(); ++i) json += (i > 0 ? ",\n" : "\n") + accessors_[i];
  json += "],\n\"bufferViews\":[";
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const std::size_t end = i + 1 < views_.size() ? views_[i + 1].begin : buffer_.size();
    json += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}{}}})", i > 0 ? ",\n" : "\n", views_[i].begin,
                        end - views_[i].begin, views_[i].rest);
  }
  json += fmt::format("],\n\"buffers\":[{{\"byteLength\":{}", buffer_.size());
  std::vector<std::byte> out;
  if (container == GltfContainer::Gltf) {
    put_text(out, json + R"(,"uri":"data:application/octet-stream;base64,)" + base64(buffer_) + "\"}]}\n");
    return out;
  }
  json += "}]}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  // Each number has four bytes, so the buffer needs no padding.
  const std::size_t size = 12 + 8 + json.size() + 8 + buffer_.size();
  if (size > most_gltf_bytes) throw file_error(path, "at most 4 GiB for a .glb", std::to_string(size) + " bytes");
  put_text(out, "glTF");
  put(out, std::uint32_t{2});
  put(out, static_cast<std::uint32_t>(size));
  put(out, static_cast<std::uint32_t>(json.size()));
  put_text(out, "JSON" + json);
  put(out, static_cast<std::uint32_t>(buffer_.size()));
  put_text(out, std::string_view("BIN\0", 4));
  out.insert(out.end(), buffer_.begin(), buffer_.end());
  return out;
}

}  // namespace sinew::io
