#pragma once
/// Edits with one mistake each, and the sentence that must name it. In a text, @ stands before the place that the
/// sentence must give.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace sinew::document {

/// A text without its @, and where that stood: "LINE:COL".
struct MarkedText {
  std::string text, place;

  explicit MarkedText(std::string marked) {
    const std::size_t at = marked.find('@');
    const std::string before = marked.substr(0, at);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    place = std::to_string(line) + ":" + std::to_string(at - (before.rfind('\n') + 1) + 1);
    text = marked.erase(at, 1);
  }
};

/// In the layer and the handle of the sentences below.
inline std::string layer_with(const std::string& members) {
  return "{\"sinew\": 1, \"layers\": [{\"method\": \"graph\", " + members + "}]}";
}
inline std::string handle_with(const std::string& members) {
  return layer_with("\"handles\": [" + members + "]");
}

/// (text, "expected ..., found ...")
inline std::vector<std::pair<std::string, std::string>> bad_edits() {
  const std::string points = "{\"points\": {\"all\": true}, ";
  return {
      {"@", "expected a value, found the end of the text"},
      {"{@", "expected a text, found the end of the text"},
      {"{\"sinew\": 1,\n  \"layers\": [@}", "expected a value, found '}'"},
      {"{\"sinew\": 1 @\"layers\": []}", "expected '}', found a text"},
      {"{\"sinew\": 0@1}", "expected '}', found a number"},
      {"{\"sinew\": @nan}", "expected JSON, found invalid literal"},
      {"{\"sinew\": @1e999, \"layers\": []}", "expected a number that fits a double, found \"1e999\""},
      {"@[]", "expected an object, found an array of 0"},
      {"@{}", "expected \"sinew\", \"layers\", found an object without members"},
      {"{\"sinew\": @2, \"layers\": []}", "expected version 1 of the format, found 2"},
      {"{\"sinew\": @\"1\", \"layers\": []}", "expected a whole number from -2147483648 to 2147483647, found \"1\""},
      {"{\"sinew\": 1, \"layers\": @{}}", "expected an array, found an object"},
      {"{\"sinew\": 1, \"layers\": [], @\"layers\": []}", "expected each name once, found \"layers\" again"},
      {"{\"sinew\": 1, @\"layer\": []}",
       "expected one of \"sinew\", \"inputs\", \"input_hashes\", \"layers\", found \"layer\""},
      {"{\"sinew\": 1, \"inputs\": [\"a\"], \"input_hashes\": @[], \"layers\": []}",
       "expected as many hashes as \"inputs\", 1, found 0"},
      {"{\"sinew\": 1, \"inputs\": [\"a\"], \"input_hashes\": [@\"md5:00\"], \"layers\": []}",
       "expected \"sha256:\" and 64 hexadecimal digits, found \"md5:00\""},
      {"{\"sinew\": 1, \"layers\": [@{}]}", "expected \"method\", found an object without members"},
      {"{\"sinew\": 1, \"layers\": [{\"method\": @3}]}", "expected a text, found 3"},
      {layer_with("@\"setings\": {}"),
       "expected one of \"name\", \"off\", \"method\", \"settings\", \"frame\", \"path\", \"cuts\", \"tets\", "
       "\"markers\", "
       "\"nodes\", "
       "\"fixed\", \"handles\", \"rigid\", "
       "\"stiffness\", \"examples\", \"example_weights\", \"examples_of\", \"keys\", \"start\", found \"setings\""},
      {layer_with("\"settings\": {\"nodes\": @true}"), "expected a number or a text, found true"},
      {layer_with("\"path\": @{\"points\": [[0, 0, 0], [1, 1, 1]], \"every\": 2}"),
       "expected \"points\" alone, or \"id\" and \"every\", found both"},
      {layer_with("\"path\": {\"points\": @[[0, 0, 0]]}"), "expected two points or more, found fewer"},
      {layer_with("\"path\": {\"every\": @0}"), "expected a whole number of at least 1, found 0"},
      {layer_with("\"cuts\": [{\"path\": @[[0, 0, 0]], \"depth\": [0, 0, 1]}]"),
       "expected two points or more, found fewer"},
      {layer_with("\"cuts\": [{\"path\": [[0, 0, 0], [1, 0, 0]], \"depth\": @[0, 0, 0]}]"),
       "expected a depth above 0, found [0, 0, 0]"},
      {layer_with("\"keys\": [{\"frame\": 2, \"handles\": []}, @{\"frame\": 2, \"handles\": []}]"),
       "expected keys in ascending order of frames, found frame 2"},
      {layer_with("\"keys\": [@{\"frame\": 2, \"handles\": [{\"move\": [0, 0, 1]}]}]"),
       "expected at most 0 motions, one a handle of the layer, found 1"},
      {layer_with("\"keys\": [{\"frame\": 2, \"handles\": [], \"interpolation\": @\"bezier\"}]"),
       "expected \"linear\", \"smooth\" or \"hold\", found \"bezier\""},
      {layer_with("\"off\": @1"), "expected true or false, found 1"},
      {layer_with("\"fixed\": @{\"all\": true}"), "expected an array, found an object"},
      {layer_with("\"fixed\": [@{}]"),
       "expected a selection, one of \"all\", \"indices\", \"box\", \"sphere\", \"nearest\", \"component\", "
       "\"labels\", \"places\", found an object without members"},
      {layer_with("\"fixed\": [@{\"boxes\": 1}]"),
       "expected a selection, one of \"all\", \"indices\", \"box\", \"sphere\", \"nearest\", \"component\", "
       "\"labels\", \"places\", found \"boxes\""},
      {layer_with("\"fixed\": [@{\"all\": true, \"component\": 1}]"),
       "expected a selection, one of \"all\", \"indices\", \"box\", \"sphere\", \"nearest\", \"component\", "
       "\"labels\", \"places\", found \"all\" and \"component\""},
      {layer_with("\"fixed\": [{\"all\": @false}]"), "expected true, found false"},
      {layer_with("\"fixed\": [{\"indices\": [0, @-1]}]"), "expected a whole number from 0 to 4294967294, found -1"},
      {layer_with("\"fixed\": [{\"indices\": [@1.5]}]"), "expected a whole number from 0 to 4294967294, found 1.5"},
      {layer_with("\"fixed\": [{\"indices\": @3}]"), "expected an array, found 3"},
      {layer_with("\"fixed\": [{\"box\": @[[0,0,0]]}]"), "expected 2 corners [min, max], found an array of 1"},
      {layer_with("\"fixed\": [{\"box\": [[0,0,0],@[1,1]]}]"), "expected 3 numbers [x, y, z], found an array of 2"},
      {layer_with("\"fixed\": [{\"box\": @[[0,0,2],[1,1,1]]}]"),
       "expected a box whose min is nowhere above its max, found one that is"},
      {layer_with("\"fixed\": [{\"sphere\": @{\"center\": [0,0,0]}}]"), "expected \"radius\", found only \"center\""},
      {layer_with("\"fixed\": [{\"sphere\": {\"center\": [0,0,0], \"radius\": @-1}}]"),
       "expected a number of at least 0, found -1"},
      {layer_with("\"fixed\": [{\"nearest\": [0, @\"a\", 0]}]"), "expected a number, found \"a\""},
      {layer_with("\"fixed\": [@{\"labels\": \"a.sel\"}]"), "expected \"value\", found only \"labels\""},
      {handle_with("@{\"move\": [0,0,0]}"), "expected \"points\", found only \"move\""},
      {handle_with("@{\"points\": {\"all\": true}}"),
       "expected a motion: \"move\", \"rotate\", \"matrix\" or \"to\", found none"},
      {handle_with(points + "\"to\": @[[0,0,0]], \"move\": [0,0,0]}"),
       "expected \"to\" alone, found another motion beside it"},
      {handle_with(points + "\"to\": @[]}"), "expected at least one target, found none"},
      {handle_with(points + "\"rotate\": {\"axis\": @[0,0,0], \"degrees\": 1}}"),
       "expected an axis of a length above 0, found [0, 0, 0]"},
      {handle_with(points + "\"matrix\": @[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,2]]}"),
       "expected a last row of [0, 0, 0, 1], found another"},
      {handle_with(points + "\"matrix\": [@1,0,0,0]}"), "expected 4 numbers, a row of the matrix, found 1"},
      {layer_with("\"stiffness\": [{\"points\": {\"all\": true}, \"factor\": @0}]"),
       "expected a number above 0, found 0"},
      {layer_with("\"examples\": [@3]"), "expected a text, found 3"},
      {layer_with("\"keys\": [{\"frame\": @1.5, \"handles\": []}]"),
       "expected a whole number from -2147483648 to 2147483647, found 1.5"},
      {layer_with("\"start\": [@[1,2,3]]"), "expected 12 numbers, a 3x4 matrix row by row, found an array of 3"},
  };
}

}  // namespace sinew::document
