#pragma once
/// Makes PLY files of any layout and encoding for tests, by a way of its own.

#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace sinew::io {

struct MadeProperty {
  std::string type, name;                   ///< type as the header says it, e.g. "float", "list uchar int"
  std::vector<std::vector<double>> values;  ///< of each row; one value unless it is a list
};

struct MadeElement {
  std::string name;
  std::vector<MadeProperty> properties;

  std::size_t rows() const { return properties.front().values.size(); }
};

struct MadePly {
  std::string encoding = "ascii";  ///< as the header says it
  std::string end = "\n";          ///< of the lines of the header and of ascii data
  std::vector<std::string> comments;
  std::vector<MadeElement> elements;
};

/// A list property's "list uchar int" in words.
inline std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> out{""};
  for (const char c : text) {
    if (c == ' ') {
      out.emplace_back();
    } else {
      out.back() += c;
    }
  }
  return out;
}

template <class T>
std::string bits(double x, bool big) {
  const T value = static_cast<T>(x);
  std::string out(sizeof(T), '\0');
  std::memcpy(out.data(), &value, sizeof(T));
  if (big == (std::endian::native == std::endian::little)) out.assign(out.rbegin(), out.rend());
  return out;
}

inline std::string encoded(const std::string& type, double x, const std::string& encoding) {
  if (encoding == "ascii") {
    char buffer[40];
    std::snprintf(buffer, sizeof(buffer), type == "double" || type == "float64" ? "%.17g " : "%.9g ", x);
    return buffer;
  }
  const bool big = encoding == "binary_big_endian";
  if (type == "char" || type == "int8") return bits<std::int8_t>(x, big);
  if (type == "uchar" || type == "uint8") return bits<std::uint8_t>(x, big);
  if (type == "short" || type == "int16") return bits<std::int16_t>(x, big);
  if (type == "ushort" || type == "uint16") return bits<std::uint16_t>(x, big);
  if (type == "int" || type == "int32") return bits<std::int32_t>(x, big);
  if (type == "uint" || type == "uint32") return bits<std::uint32_t>(x, big);
  if (type == "float" || type == "float32") return bits<float>(x, big);
  return bits<double>(x, big);
}

inline std::string made(const MadePly& ply) {
  std::string out = "ply" + ply.end + "format " + ply.encoding + " 1.0" + ply.end;
  for (const std::string& comment : ply.comments) out += comment + ply.end;
  for (const MadeElement& element : ply.elements) {
    out += "element " + element.name + " " + std::to_string(element.rows()) + ply.end;
    for (const MadeProperty& p : element.properties) out += "property " + p.type + " " + p.name + ply.end;
  }
  out += "end_header" + ply.end;
  for (const MadeElement& element : ply.elements)
    for (std::size_t row = 0; row < element.rows(); ++row) {
      for (const MadeProperty& p : element.properties) {
        const auto w = words(p.type);
        if (w.front() == "list") out += encoded(w[1], static_cast<double>(p.values[row].size()), ply.encoding);
        for (const double x : p.values[row]) out += encoded(w.back(), x, ply.encoding);
      }
      if (ply.encoding == "ascii") out += ply.end;
    }
  return out;
}

/// One value a row.
inline MadeProperty scalars(const std::string& type, const std::string& name, const std::vector<double>& values) {
  MadeProperty p{type, name, {}};
  for (const double x : values) p.values.push_back({x});
  return p;
}

}  // namespace sinew::io
