#include "apps/samples/edits.h"

#include <map>

#include "engine/geometry/check.h"

namespace sinew::samples {

namespace {

/// The giraffe keeps its legs where they are and turns its head to look back.
constexpr const char* scan = R"({ "sinew": 1,
  "layers": [ {
    "name": "Look back",
    "method": "graph",
    "settings": { "nodes": 226, "neighbours": 4 },
    "fixed": [ { "box": [[-1, -0.1, -1], [1, 0.6, 1]] } ],
    "handles": [ { "points": { "box": [[0.5, 1.83, -0.3], [0.95, 2.3, 0.3]] },
                   "rotate": { "axis": [0, 1, 0], "degrees": 155, "about": [0.585, 1.87, 0] },
                   "move": [-0.55, -0.2, -0.35] } ]
  } ] }
)";

/// Botsch and Sorkine, Figure 10: the left side stays, the right side is lifted without turning. It moves inwards as
/// well, so that the sheet can rise without being stretched.
constexpr const char* plane = R"({ "sinew": 1,
  "layers": [ {
    "method": "graph",
    "settings": { "nodes": 300, "neighbours": 4 },
    "fixed": [ { "box": [[-0.01, -1, -1], [0.1, 1, 2]] } ],
    "handles": [ { "points": { "box": [[0.9, -1, -1], [1.01, 1, 2]] }, "move": [-0.12, 0.4, 0] } ]
  } ] }
)";

/// The upper end turns by 135 degrees about the bar's own axis.
constexpr const char* bar = R"({ "sinew": 1,
  "layers": [ {
    "method": "graph",
    "settings": { "nodes": 250, "neighbours": 4 },
    "fixed": [ { "box": [[-1, -1, -1], [1, 0.08, 1]] } ],
    "handles": [ { "points": { "box": [[-1, 1.57, -1], [1, 2, 1]] },
                   "rotate": { "axis": [0, 1, 0], "degrees": 135, "about": [0, 0, 0] }, "move": [0, 0, 0] } ]
  } ] }
)";

/// The top bends by 70 degrees, along an arc of the length that lies between it and the root.
constexpr const char* cactus = R"({ "sinew": 1,
  "layers": [ {
    "method": "graph",
    "settings": { "nodes": 250, "neighbours": 4 },
    "fixed": [ { "box": [[-1, -1, -1], [1, 0.08, 1]] } ],
    "handles": [ { "points": { "box": [[-0.1, 0.88, -1], [0.1, 2, 1]] },
                   "rotate": { "axis": [0, 0, 1], "degrees": -70, "about": [0, 0.88, 0] },
                   "move": [0.4309, -0.1847, 0] } ]
  } ] }
)";

/// The upper end bends by 120 degrees, along an arc of the cylinder's length.
constexpr const char* cylinder = R"({ "sinew": 1,
  "layers": [ {
    "method": "graph",
    "settings": { "nodes": 250, "neighbours": 4 },
    "fixed": [ { "box": [[-1, -1, -1], [1, 0.05, 1]] } ],
    "handles": [ { "points": { "box": [[-1, 1.1, -1], [1, 2, 1]] },
                   "rotate": { "axis": [0, 0, 1], "degrees": -120, "about": [0, 1.1, 0] },
                   "move": [0.7520, -0.6158, 0] } ]
  } ] }
)";

/// The giraffe of splats bows: its head goes down and forward along an arc about the root of its neck.
constexpr const char* splats = R"({ "sinew": 1,
  "layers": [ {
    "name": "Bow",
    "method": "graph",
    "settings": { "nodes": 226, "neighbours": 4 },
    "fixed": [ { "box": [[-1, -0.1, -1], [1, 0.75, 1]] } ],
    "handles": [ { "points": { "box": [[0.5, 1.83, -0.3], [0.95, 2.3, 0.3]] },
                   "rotate": { "axis": [0.3, 0.2, -1], "degrees": 70, "about": [0.26, 1.1, 0] }, "move": [0, 0, 0] } ]
  } ] }
)";

}  // namespace

std::string edit_of(const std::string& sample) {
  static const std::map<std::string, const char*> edits{{"scan", scan},     {"plane", plane},       {"bar", bar},
                                                        {"cactus", cactus}, {"cylinder", cylinder}, {"splats", splats}};
  const auto found = edits.find(sample);
  CHECK(found != edits.end(), sample);
  return found->second;
}

}  // namespace sinew::samples
