#pragma once
/// Makes the bytes of C3D files, for any processor and type of numbers; knows nothing of the reader.

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sinew::io {

struct C3dMaker {
  enum Processor { Intel = 84, Dec = 85, Mips = 86 };
  /// A parameter with its values already as bytes.
  struct Parameter {
    int group = 1;
    std::string name;
    int type = 2;
    std::vector<int> dimensions;
    std::string value;
  };

  Processor processor = Intel;
  bool real = true;
  double scale = 0.25;  ///< of integers; floats have it with a minus
  int points = 3, frames = 5, first = 1;
  int channels = 2, samples = 2;  ///< analog
  double rate = 100;
  int parameter_block = 2;
  std::vector<Parameter> parameters;                                       ///< after those that are always there
  int header_points = -1, header_last = -1, header_first = -1, used = -1;  ///< what is said instead; -1: the truth
  std::vector<std::pair<int, int>> unseen;                                 ///< frames and points
  static double value(int f, int p, int c) { return 100.0 * f - 10.25 * p + c; }  ///< in quarters

  std::string word(int x) const {
    const char low = static_cast<char>(x & 0xff), high = static_cast<char>(x >> 8 & 0xff);
    return processor == Mips ? std::string{high, low} : std::string{low, high};
  }

  /// By hand from sign, exponent and fraction: IEEE 754 has bias 127, F_floating 129 of the same 1.f.
  std::string real_number(double x) const {
    int exponent = 0;
    const double half = std::frexp(std::abs(x), &exponent);  // x = half 2^exponent, half in [0.5, 1)
    std::uint32_t bits = 0;
    if (x != 0) {
      const auto fraction = static_cast<std::uint32_t>((2 * half - 1) * 8388608.0);
      const int bias = processor == Dec ? 128 : 126;
      bits = (x < 0 ? 0x80000000U : 0U) | static_cast<std::uint32_t>(exponent + bias) << 23 | fraction;
    }
    const std::string high = word(static_cast<int>(bits >> 16)), low = word(static_cast<int>(bits & 0xffff));
    return processor == Intel ? low + high : high + low;
  }

  std::string record(const std::string& name, int group, const std::string& content) const {
    std::string out{static_cast<char>(name.size()), static_cast<char>(group)};
    out += name;
    return out + word(static_cast<int>(content.size()) + 2) + content;
  }

  std::string parameter(const Parameter& p) const {
    std::string content{static_cast<char>(p.type), static_cast<char>(p.dimensions.size())};
    for (const int d : p.dimensions) content += static_cast<char>(d);
    return record(p.name, p.group, content + p.value + std::string(1, '\0'));
  }

  static Parameter text(const std::string& name, const std::vector<std::string>& texts, std::size_t length) {
    std::string all;
    for (std::string t : texts) {
      t.resize(length, ' ');
      all += t;
    }
    return {1, name, -1, {static_cast<int>(length), static_cast<int>(texts.size())}, all};
  }

  double scale_said() const { return real ? -scale : scale; }

  std::string section() const {
    std::string out{1, 0x50, 0, static_cast<char>(processor)};
    // The locked groups and parameters of some programs have a negative length of their names.
    std::string point = record("POINT", -1, std::string(1, '\0'));
    point[0] = -5;
    out += point + record("ANALOG", -2, std::string(1, '\3') + "abc") + record("TRIAL", -3, std::string(1, '\0'));
    out += parameter({1, "USED", 2, {}, word(used < 0 ? points : used)});
    out += parameter({1, "SCALE", 4, {}, real_number(scale_said())});
    out += parameter({1, "RATE", 4, {}, real_number(rate)});
    out += parameter({2, "USED", 2, {}, word(channels)});
    for (const Parameter& p : parameters) out += parameter(p);
    return out + std::string(2, '\0');
  }

  std::string header(int data_block) const {
    std::string out{static_cast<char>(parameter_block), 0x50};
    out += word(header_points < 0 ? points : header_points) + word(channels * samples);
    out += word(header_first < 0 ? first : header_first) + word(header_last < 0 ? first + frames - 1 : header_last);
    out += word(10) + real_number(scale_said()) + word(data_block) + word(samples) + real_number(rate);
    return out;
  }

  std::string number(double x) const { return real ? real_number(x) : word(static_cast<int>(std::lround(x / scale))); }

  std::string frame(int f) const {
    std::string out;
    for (int p = 0; p < points; ++p) {
      bool hidden = false;
      for (const auto& [uf, up] : unseen) hidden = hidden || (uf == f && up == p);
      for (int c = 0; c < 3; ++c) out += number(hidden ? 0 : value(f, p, c));
      // Residual 1 and two cameras (bits 0 and 1 of the high byte), or no camera.
      out += real ? real_number(hidden ? -1 : 0x301) : word(hidden ? -1 : 0x301);
    }
    for (int a = 0; a < channels * samples; ++a) out += real ? real_number(-7.5) : word(-1000 - a);
    return out;
  }

  static void pad(std::string& out) { out.resize((out.size() + 511) / 512 * 512, '\0'); }

  std::string bytes() const {
    const std::string parameter_bytes = section();
    const int blocks = static_cast<int>((parameter_bytes.size() + 511) / 512);
    std::string out = header(parameter_block + blocks);
    out.resize(static_cast<std::size_t>(parameter_block - 1) * 512, '\0');
    out += parameter_bytes;
    pad(out);
    for (int f = 0; f < frames; ++f) out += frame(f);
    pad(out);
    return out;
  }
};

}  // namespace sinew::io
