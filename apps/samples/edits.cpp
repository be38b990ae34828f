#include "apps/samples/edits.h"

#include <map>

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

/// As the plane, by a solid with fewer vertices than the slab has.
constexpr const char* slab = R"({ "sinew": 1,
  "layers": [ {
    "method": "tet",
    "settings": { "vertices": 8000 },
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

/// The upper end turns by 135 degrees; a block in the middle turns as one, and below it the bar is stiffer.
constexpr const char* bar_rigid = R"({ "sinew": 1,
  "layers": [ {
    "method": "tet",
    "settings": { "vertices": 700, "filling": "inside" },
    "fixed": [ { "box": [[-1, -1, -1], [1, 0.08, 1]] } ],
    "rigid": [ { "box": [[-1, 0.9, -1], [1, 1.2, 1]] } ],
    "stiffness": [ { "points": { "box": [[-1, 0.3, -1], [1, 0.6, 1]] }, "factor": 8 } ],
    "handles": [ { "points": { "box": [[-1, 1.57, -1], [1, 2, 1]] },
                   "rotate": { "axis": [0, 1, 0], "degrees": 135, "about": [0, 0, 0] }, "move": [0, 0, 0] } ]
  } ] }
)";

/// The upper end turns by 135 degrees about the bar's own axis, by a solid with points inside.
constexpr const char* bar_tet = R"({ "sinew": 1,
  "layers": [ {
    "method": "tet",
    "settings": { "vertices": 10000, "filling": "inside" },
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

constexpr const char* cactus_tet = R"({ "sinew": 1,
  "layers": [ {
    "method": "tet",
    "settings": { "vertices": 10000 },
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

constexpr const char* cylinder_tet = R"({ "sinew": 1,
  "layers": [ {
    "method": "tet",
    "settings": { "vertices": 10000 },
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

/// Sumner, Schmid and Pauly, Figure 8: legs and neck become longer and the head turns, by a key on the first pose. The
/// hooves go where the animation has them.
constexpr const char* walk = R"({ "sinew": 1,
  "layers": [ {
    "name": "Long legs and neck",
    "method": "graph",
    "settings": { "nodes": 303, "neighbours": 4 },
    "fixed": [ { "box": [[-1, -0.1, -1], [1, 0.08, 1]] }, { "box": [[0.04, 0.05, -0.2], [0.2, 0.16, 0]] } ],
    "handles": [ { "points": { "box": [[-0.36, 0.76, -0.3], [0.28, 1.03, 0.3]] }, "move": [0, 0.3, 0] },
                 { "points": { "box": [[0.64, 1.10, -0.3], [1.2, 1.7, 0.3]] },
                   "rotate": { "axis": [0, 1, 0], "degrees": -50, "about": [0.68, 1.36, 0] },
                   "move": [0.05, 0.75, 0] } ],
    "keys": [ { "frame": 1,
                "handles": [ { "move": [0, 0.3, 0] },
                             { "rotate": { "axis": [0, 1, 0], "degrees": -50, "about": [0.68, 1.36, 0] },
                               "move": [0.05, 0.75, 0] } ] } ]
  } ] }
)";

/// The chair bows to its side: its feet stay, the crest of its back comes over and down.
constexpr const char* soup = R"({ "sinew": 1,
  "layers": [ {
    "name": "Bow",
    "method": "graph",
    "settings": { "nodes": 250, "neighbours": 4 },
    "fixed": [ { "box": [[-1, -0.1, -1], [1, 0.06, 1]] } ],
    "handles": [ { "points": { "box": [[-1, 0.98, -1], [1, 1.2, 1]] },
                   "rotate": { "axis": [1, 0.5, 0], "degrees": 50, "about": [-0.3, 1.0, 0] },
                   "move": [0.06, -0.12, 0.36] } ]
  } ] }
)";

/// The jet's nozzle stays; where it comes down is carried to the side, and its arc swings and rises along.
constexpr const char* jet = R"({ "sinew": 1,
  "layers": [ {
    "name": "Swing",
    "method": "graph",
    "settings": { "neighbours": 3 },
    "path": { "every": 4 },
    "fixed": [ { "box": [[-0.2, 0, -0.5], [0.25, 2, 0.5]], "frame": 40 } ],
    "handles": [ { "points": { "box": [[0.5, 0.5, -0.5], [0.9, 0.9, 0.5]], "frame": 40 }, "move": [0, 0.1, 0.12] },
                 { "points": { "box": [[1.3, 0, -0.5], [2.2, 0.2, 0.5]], "frame": 40 }, "move": [0, 0, 0.6] } ]
  } ] }
)";

/// The foal by its poses: the hooves stay, one point of the muzzle goes where `move` says, and all else takes the pose
/// between the examples that suits these best.
std::string posed_foal(const std::string& examples, const std::string& move) {
  return R"({ "sinew": 1,
  "layers": [ {
    "method": "shell",
    "settings": { "vertices": 1000 },
    "examples": [ )" +
         examples + R"( ],
    "fixed": [ { "box": [[-1, -0.1, -1], [1, 0.03, 1]] } ],
    "handles": [ { "points": { "sphere": { "center": [0.9919, 1.0967, 0.0115], "radius": 0.012 } }, "move": )" +
         move + R"( } ]
  } ] }
)";
}

/// Froehlich and Botsch, Figure 5: so much of the way from rest to a pose, or beyond it.
std::string blended_foal(const std::string& weight) {
  return R"({ "sinew": 1,
  "layers": [ { "method": "shell", "settings": { "vertices": 1000 },
                "examples": [ "poses/rear.obj" ], "example_weights": [ )" +
         weight + R"( ] } ] }
)";
}

/// Figure 7: the example stands turned about; Figure 8: what is asked for is far from the examples.
std::vector<std::pair<std::string, std::string>> foal_edits() {
  return {{"shell", posed_foal(R"("poses")", "[-0.3, -0.1, -0.5]")},
          {"turned", posed_foal(R"("foal.turned.obj")", "[-0.3, -0.75, 0]")},
          {"far", posed_foal(R"("poses/stride-left.obj", "poses/head-down.obj")", "[-0.3, 0.1, -0.6]")},
          {"blend35", blended_foal("0.35")},
          {"blend65", blended_foal("0.65")},
          {"blend100", blended_foal("1")},
          {"blend125", blended_foal("1.25")}};
}

/// Halfway between the straight tube and its three turns.
constexpr const char* helix = R"({ "sinew": 1,
  "layers": [ {
    "method": "shell",
    "settings": { "vertices": 0 },
    "examples": [ "helix.wound.obj" ],
    "example_weights": [ 0.5 ]
  } ] }
)";

/// The graph's edit by a shell. A solid one is thick enough to resist bending, and keeps its volume.
std::string as_shell(const std::string& edit, const char* settings) {
  const std::size_t from = edit.find("\"method\""), to = edit.find("\"fixed\"");
  return edit.substr(0, from) + "\"method\": \"shell\",\n    \"settings\": { " + settings + " },\n    " +
         edit.substr(to);
}
constexpr const char* of_sheet = R"("vertices": 1000)";
constexpr const char* of_solid = R"("vertices": 0, "bend": 100, "volume": 100000)";

}  // namespace

std::string edit_of(const std::string& sample) {
  static const std::map<std::string, const char*> edits{
      {"scan", scan},     {"plane", plane}, {"bar", bar},   {"cactus", cactus}, {"cylinder", cylinder},
      {"splats", splats}, {"walk", walk},   {"soup", soup}, {"jet", jet},       {"slab", slab}};
  const auto found = edits.find(sample);
  return found == edits.end() ? "" : found->second;
}

std::vector<std::pair<std::string, std::string>> more_edits_of(const std::string& sample) {
  if (sample == "plane") return {{"shell", as_shell(plane, of_sheet)}};
  if (sample == "bar") return {{"tet", bar_tet}, {"rigid", bar_rigid}, {"shell", as_shell(bar, of_solid)}};
  if (sample == "cactus") return {{"tet", cactus_tet}, {"shell", as_shell(cactus, of_solid)}};
  if (sample == "cylinder") return {{"tet", cylinder_tet}, {"shell", as_shell(cylinder, of_solid)}};
  if (sample == "foal") return foal_edits();
  if (sample == "helix") return {{"shell", helix}};
  return {};
}

}  // namespace sinew::samples
