#pragma once
/// R.json: what `deform` and `blend` measured (interface.md gives the fields). Fields that do not apply are absent.

#include <optional>
#include <string>
#include <vector>

#include "engine/document/json.h"
#include "engine/geometry/deformer.h"
#include "engine/geometry/topology.h"

namespace sinew::document {

struct InputReport {
  std::string representation;
  std::size_t points = 0, faces = 0, tets = 0, components = 0, frames = 1;
};
/// Counts components: seconds for a scan of many million points.
InputReport report_of(const Shape& input);

/// How far a handle's points came to be from their targets.
struct HandleReport {
  std::string name;  ///< HandleEdit::name
  std::size_t points = 0;
  double max = 0, rms = 0;  ///< in units of the input's bounding-box diagonal
};

/// Energies as the solver has them; distances in units of the input's bounding-box diagonal; times in seconds,
/// measured.
struct LayerReport {
  std::string method;
  SolveReport solve;
  Figures counts;                  ///< of the deformer's structure
  std::vector<std::string> notes;  ///< what was left out in making it, one sentence each
  double handle_max = 0, handle_rms = 0;
  std::vector<HandleReport> handles;  ///< of those that have points
  Quality quality;
  double build = 0;  ///< making the deformer: its structure, and binding the points for the first time
  double bind = 0;   ///< binding all points once more
  double skin = 0;   ///< moving all points once
};

/// Takes in the report of another frame of the same layer: the worst status, the largest errors and strains, the energy
/// of the frame that has the most; iterations and seconds of all frames together; what was made once as it was.
void add_frame(LayerReport& all, const LayerReport& frame);

struct Report {
  InputReport input;
  std::vector<LayerReport> layers;
  double read = 0, write = 0, total = 0;
};

/// The text of R.json.
std::string report_text(const Report& report);

/// The members of "input", for other outputs that show them.
void write_members(JsonWriter& out, const InputReport& input);

}  // namespace sinew::document
