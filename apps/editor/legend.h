#pragma once
/// Legend: the bar of colours beside the scene, as numbers: how far it reaches, its ticks, and what a drag of its ends
/// does. Places on the bar are 0 (its low end) to 1.

#include <string>
#include <vector>

#include "engine/document/field.h"

namespace sinew::editor {

enum class LegendPart { None, Low, High, Both };  ///< Both: between the ends, to move them together

/// The numbers at the ends of the bar: the usual range and the chosen one, with a quarter of it as room on both sides
/// to drag into, as far as there are values.
document::ValueRange legend_domain(const document::ValueRange& range, const document::ValueRange& usual,
                                   const document::ValueRange& extent);

double place_of(const document::ValueRange& domain, double value);
double value_at(const document::ValueRange& domain, double place);

/// What a press at `place` takes hold of: the end that is within `reach`, else both where it lies between them.
LegendPart legend_part(const document::ValueRange& domain, const document::ValueRange& range, double place,
                       double reach);

/// The range `before` after a drag by `by` (of the bar). Ends stay in the domain and a hundredth of it apart. `around`:
/// the ends mirror each other about 0.
document::ValueRange dragged(const document::ValueRange& before, LegendPart part, double by,
                             const document::ValueRange& domain, bool around);

/// At most `most` + 1 round numbers (1, 2 or 5 times a power of ten apart) within the domain.
struct Ticks {
  std::vector<double> values;
  double step = 1;
};
Ticks ticks_of(const document::ValueRange& domain, int most);
/// With as many digits as the step needs: "0.25", "-1500", "2.5e-07".
std::string tick_text(double value, double step);

}  // namespace sinew::editor
