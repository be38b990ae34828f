#include "apps/sinew/input_check.h"

#include "apps/sinew/files.h"
#include "engine/document/input_hash.h"

namespace sinew::app {

InputCheck::InputCheck(const std::string& input, const std::vector<std::string>& expected) : input_(input) {
  if (input == "-" || expected.empty()) return;
  expected_ = expected.front();
  hash_ = std::async(std::launch::async, [this] { return document::input_hash(input_, [this] { return !stop_; }); });
}

InputCheck::~InputCheck() {
  stop_ = true;
}

void InputCheck::tell() {
  if (hash_.valid() && hash_.get() != expected_) message("warning: " + document::sentence_of_other_input(input_));
}

}  // namespace sinew::app
