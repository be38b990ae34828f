#include "engine/document/journal_format.h"

#include <bit>
#include <cstring>

#include "engine/document/edit.h"
#include "engine/document/journal.h"
#include "engine/io/bytes.h"
#include "engine/io/sha256.h"

namespace sinew::document {

namespace journal {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

namespace {

constexpr std::size_t check_size = 8;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

/// The first bytes of a record.
std::array<std::byte, head> head_of(std::span<const std::byte> content) {
  std::array<std::byte, head> out;
  const std::uint64_t size = content.size();
  std::memcpy(out.data(), &size, sizeof(size));
  io::Sha256 hash;
  hash.add(std::span(out).first(sizeof(size)));
  hash.add(content);
  const io::Sha256::Digest digest = hash.digest();
  std::memcpy(out.data() + sizeof(size), digest.data(), check_size);
  return out;
}

/// A record whose content is added piece by piece.
class Record {
 public:
  Record(std::vector<std::byte>& out, Kind kind) : out_(out), begin_(out.size()) {
    out_.resize(begin_ + head);
    out_.push_back(static_cast<std::byte>(kind));
  }
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;
  ~Record() {
    const std::array<std::byte, head> first = head_of(std::span(out_).subspan(begin_ + head));
    std::memcpy(out_.data() + begin_, first.data(), head);
  }

  void add(std::string_view text) {
    const std::span<const std::byte> bytes = bytes_of(text);
    out_.insert(out_.end(), bytes.begin(), bytes.end());
  }
  void add(std::uint64_t number) { add({reinterpret_cast<const char*>(&number), sizeof(number)}); }

 private:
  std::vector<std::byte>& out_;
  std::size_t begin_;
};

}  // namespace

void put_state(std::vector<std::byte>& out, SharedArrays& arrays, std::uint64_t index, const History::State& state) {
  const std::size_t before = arrays.size();
  const std::string text = edit_text(state.project, arrays);
  for (std::size_t i = before; i < arrays.size(); ++i) {
    Record record(out, Kind::Array);
    const char element = static_cast<char>(arrays.at(i).index() + 1);
    record.add({&element, 1});
    std::visit([&](const auto& array) { record.add(SharedArrays::bytes_of(array)); }, arrays.at(i));
  }
  Record record(out, Kind::State);
  record.add(index);
  record.add(state.label.size());
  record.add(state.label);
  record.add(text);
}

void put_present(std::vector<std::byte>& out, std::uint64_t index) {
  Record(out, Kind::Present).add(index);
}

void put_saved(std::vector<std::byte>& out, std::uint64_t index, const std::string& path) {
  Record record(out, Kind::Saved);
  record.add(index);
  record.add(path);
}

void put_hashes(std::vector<std::byte>& out, const std::vector<std::string>& hashes) {
  Record record(out, Kind::Hashes);
  for (const std::string& hash : hashes) record.add(hash + "\n");
}

namespace {

template <class T>
Shared<T> array_of(std::span<const std::byte> bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), values.size() * sizeof(T));
  return Shared<T>(std::move(values));
}

/// Takes in records one after the other.
class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {}

  /// False, and nothing is changed, where it can't follow what was there before it.
  bool take(std::span<const std::byte> bytes) {
    io::ByteCursor cursor(path_, bytes);
    const auto number = [&] { return cursor.number<std::uint64_t>(false, "a number"); };
    const auto rest = [&] { return io::as_text(cursor.take(cursor.left(), "the rest")); };
    switch (static_cast<Kind>(cursor.number<std::uint8_t>(false, "the kind"))) {
      case Kind::Array: return take_array(cursor.number<std::uint8_t>(false, "the elements"), cursor);
      case Kind::State: {
        const std::uint64_t index = number(), length = number();
        std::string label(io::as_text(cursor.take(length, "the label")));
        return take_state(index, std::move(label), std::string(rest()));
      }
      case Kind::Present: {
        const std::uint64_t index = number();
        if (index < content.states.size()) content.present = index;
        return content.present == index;
      }
      case Kind::Saved: {
        const std::uint64_t index = number();
        if (index != none && index >= content.states.size()) return false;
        content.saved = index == none ? std::nullopt : std::optional<std::size_t>(index);
        content.edit_path = rest();
        return true;
      }
      case Kind::Hashes: {
        const std::string_view lines = rest();
        content.hashes.clear();
        for (std::size_t begin = 0, end; (end = lines.find('\n', begin)) != lines.npos; begin = end + 1)
          content.hashes.emplace_back(lines.substr(begin, end - begin));
        return true;
      }
    }
    return false;
  }

  JournalContent content;

 private:
  bool take_array(std::uint8_t element, io::ByteCursor& cursor) {
    const std::span<const std::byte> bytes = cursor.take(cursor.left(), "the array");
    switch (element) {
      case 1: arrays_.add(array_of<Index>(bytes)); return true;
      case 2: arrays_.add(array_of<Vec3>(bytes)); return true;
      case 3: arrays_.add(array_of<Affine>(bytes)); return true;
      default: return false;
    }
  }

  bool take_state(std::uint64_t index, std::string label, std::string text) {
    if (index > content.states.size()) return false;
    Project project = parse_edit(path_, std::move(text), &arrays_);
    content.states.resize(index);
    if (content.saved && *content.saved >= index) content.saved.reset();
    content.states.push_back({std::move(label), std::move(project)});
    content.present = index;
    return true;
  }

  std::string path_;
  SharedArrays arrays_;
};

/// The content of the record at `at`; nothing where it is not whole.
std::optional<std::span<const std::byte>> record_at(std::span<const std::byte> bytes, std::size_t at) {
  if (bytes.size() - at < head) return std::nullopt;
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data() + at, sizeof(size));
  if (size == 0 || size > bytes.size() - at - head) return std::nullopt;
  const std::span<const std::byte> content = bytes.subspan(at + head, size);
  const std::array<std::byte, head> expected = head_of(content);
  if (std::memcmp(expected.data(), bytes.data() + at, head) != 0) return std::nullopt;
  return content;
}

}  // namespace

}  // namespace journal

JournalContent parse_journal(const std::string& path, std::span<const std::byte> bytes) {
  journal::Reader reader(path);
  const std::string_view text = io::as_text(bytes);
  if (text.size() < journal::magic.size() && journal::magic.starts_with(text)) {
    reader.content.torn = bytes.size();
    return reader.content;
  }
  if (!text.starts_with(journal::magic)) throw file_error(path, "a journal of version 1", "another file");
  std::size_t at = journal::magic.size();
  while (const std::optional<std::span<const std::byte>> record = journal::record_at(bytes, at)) {
    if (!reader.take(*record)) break;
    at += journal::head + record->size();
  }
  reader.content.torn = bytes.size() - at;
  return reader.content;
}

}  // namespace sinew::document
