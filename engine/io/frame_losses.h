#pragma once
/// What the frames of one output lose, told once: from the reports of many frames, written in any order, one report.

#include <map>
#include <mutex>
#include <set>

#include "engine/io/io.h"

namespace sinew::io {

class FrameLosses {
 public:
  /// From any thread.
  void add(int frame, WriteReport report) {
    if (report.lost.empty()) return;
    const std::scoped_lock lock(mutex_);
    reports_[frame] = std::move(report);
  }

  /// Sentences that differ in their numbers only are one, in the words of the first frame.
  WriteReport merged() const {
    const std::scoped_lock lock(mutex_);
    WriteReport out;
    std::set<std::string> told;
    for (const auto& [frame, report] : reports_)
      for (const std::string& sentence : report.lost)
        if (told.insert(without_numbers(sentence)).second) out.lost.push_back(sentence);
    return out;
  }

 private:
  static std::string without_numbers(const std::string& sentence) {
    std::string out;
    bool quoted = false;
    for (const char c : sentence) {
      quoted = quoted != (c == '"');
      const bool number = (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e' || c == 's';
      if (quoted || !number) out += c;
    }
    return out;
  }

  mutable std::mutex mutex_;
  std::map<int, WriteReport> reports_;
};

}  // namespace sinew::io
