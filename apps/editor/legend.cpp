#include "apps/editor/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sinew::editor {

using document::ValueRange;

ValueRange legend_domain(const ValueRange& range, const ValueRange& usual, const ValueRange& extent) {
  const double room = 0.25 * (usual.high - usual.low);
  ValueRange out{std::max(extent.low, usual.low - room), std::min(extent.high, usual.high + room)};
  out.low = std::min({out.low, usual.low, range.low});
  out.high = std::max({out.high, usual.high, range.high});
  if (!(out.high > out.low)) {  // one value everywhere
    const double half = out.low == 0 ? 0.5 : 0.5 * std::abs(out.low);
    out = {out.low - half, out.high + half};
  }
  return out;
}

double place_of(const ValueRange& domain, double value) {
  return (value - domain.low) / (domain.high - domain.low);
}

double value_at(const ValueRange& domain, double place) {
  return domain.low + place * (domain.high - domain.low);
}

LegendPart legend_part(const ValueRange& domain, const ValueRange& range, double place, double reach) {
  const double low = std::abs(place - place_of(domain, range.low)),
               high = std::abs(place - place_of(domain, range.high));
  if (std::min(low, high) <= reach) {
    // Ends that lie together are pulled apart by the side that was pressed.
    if (low == high) return place > place_of(domain, range.low) ? LegendPart::High : LegendPart::Low;
    return low < high ? LegendPart::Low : LegendPart::High;
  }
  const double value = value_at(domain, place);
  return value > range.low && value < range.high ? LegendPart::Both : LegendPart::None;
}

ValueRange dragged(const ValueRange& before, LegendPart part, double by, const ValueRange& domain, bool around) {
  const double whole = domain.high - domain.low, least = 0.01 * whole, change = by * whole;
  ValueRange out = before;
  switch (part) {
    case LegendPart::Low: out.low = std::clamp(before.low + change, domain.low, before.high - least); break;
    case LegendPart::High: out.high = std::clamp(before.high + change, before.low + least, domain.high); break;
    case LegendPart::Both: {
      const double move = std::clamp(change, domain.low - before.low, domain.high - before.high);
      return {before.low + move, before.high + move};
    }
    case LegendPart::None: return before;
  }
  if (around) {
    const double half = std::max(least, part == LegendPart::Low ? -out.low : out.high);
    return {-half, half};
  }
  return out;
}

Ticks ticks_of(const ValueRange& domain, int most) {
  const double whole = domain.high - domain.low;
  Ticks out;
  if (!(whole > 0) || !std::isfinite(whole)) return out;
  const double power = std::pow(10, std::floor(std::log10(whole / most)));
  for (const double digit : {1.0, 2.0, 5.0, 10.0}) {
    out.step = digit * power;
    if (whole / out.step <= most) break;
  }
  // Where doubles lie as far apart as the ticks would, there are none.
  if (out.step < 1e-9 * std::max(std::abs(domain.low), std::abs(domain.high))) return out;
  for (double i = std::ceil(domain.low / out.step - 1e-9); i * out.step <= domain.high + 1e-9 * whole; ++i)
    out.values.push_back(i * out.step);
  return out;
}

std::string tick_text(double value, double step) {
  const double size = std::max(std::abs(value), step);
  if (size >= 1e6 || size < 1e-3) return fmt::format("{:.2g}", value);
  const int digits = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  const std::string text = fmt::format("{:.{}f}", value, digits);
  return text.find_first_not_of("-0.") == std::string::npos ? fmt::format("{:.{}f}", 0.0, digits) : text;
}

}  // namespace sinew::editor
