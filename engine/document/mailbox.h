#pragma once
/// Mailbox: one slot between two threads; the newest letter wins.

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

namespace sinew::document {

template <class Letter>
class Mailbox {
 public:
  /// Replaces a letter that was not taken.
  void put(Letter letter) {
    {
      const std::lock_guard lock(mutex_);
      slot_ = std::move(letter);
    }
    filled_.notify_one();
  }

  std::optional<Letter> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(slot_, std::nullopt);
  }

  /// Waits for a letter; nothing once the box is closed.
  std::optional<Letter> wait() {
    std::unique_lock lock(mutex_);
    filled_.wait(lock, [this] { return closed_ || slot_; });
    if (closed_) return std::nullopt;
    return std::exchange(slot_, std::nullopt);
  }

  /// Whether the letter in the slot, if there is one, is such.
  bool holds(const std::function<bool(const Letter&)>& such) const {
    const std::lock_guard lock(mutex_);
    return slot_ && such(*slot_);
  }

  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    filled_.notify_all();
  }
  bool closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable filled_;
  std::optional<Letter> slot_;
  bool closed_ = false;
};

}  // namespace sinew::document
