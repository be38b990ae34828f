#pragma once
/// InputCheck: whether the input is the one that an edit was saved with, found while it is read and bent.

#include <atomic>
#include <future>
#include <string>
#include <vector>

namespace sinew::app {

class InputCheck {
 public:
  /// `expected`: the hashes of the edit (input_hash.h), of which the first counts; without any, or for standard input,
  /// there is nothing to check.
  InputCheck(const std::string& input, const std::vector<std::string>& expected);
  InputCheck(const InputCheck&) = delete;
  InputCheck& operator=(const InputCheck&) = delete;
  ~InputCheck();  ///< stops it where tell() was not called

  /// Waits, and tells on standard error where it is another.
  void tell();

 private:
  std::string input_, expected_;
  std::atomic<bool> stop_ = false;
  std::future<std::string> hash_;  ///< last: it goes first
};

}  // namespace sinew::app
