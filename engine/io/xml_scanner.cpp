#include "engine/io/xml_scanner.h"

#include <algorithm>
#include <charconv>

namespace sinew::io {

namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool ends_name(char c) {
  return is_space(c) || c == '/' || c == '>' || c == '=' || c == '<' || c == '"' || c == '\'';
}

std::string_view name_at(std::string_view text, std::size_t at) {
  const auto* const begin = text.data() + std::min(at, text.size());
  const auto* const end = std::find_if(begin, text.data() + text.size(), ends_name);
  return {begin, static_cast<std::size_t>(end - begin)};
}

std::size_t skip_space(std::string_view text, std::size_t at) {
  while (at < text.size() && is_space(text[at])) ++at;
  return at;
}

}  // namespace

std::string XmlTag::value(std::string_view attribute, const std::string& otherwise) const {
  for (const auto& [known, text] : attributes)
    if (known == attribute) return text;
  return otherwise;
}

InputError XmlScanner::error(const XmlTag& at, const std::string& expected, const std::string& found) const {
  return text_error(path_, at.line, at.column, expected, found);
}

void XmlScanner::advance(std::size_t to) {
  for (; at_ < to; ++at_)
    if (text_[at_] == '\n') {
      ++line_;
      line_begin_ = at_ + 1;
    }
}

bool XmlScanner::skip(std::string_view opening, std::string_view closing) {
  if (!text_.substr(at_).starts_with(opening)) return false;
  const std::size_t end = text_.find(closing, at_ + opening.size());
  if (end == std::string_view::npos)
    throw text_error(path_, line_, static_cast<std::int64_t>(at_ - line_begin_) + 1,
                     "\"" + std::string(closing) + "\" behind \"" + std::string(opening) + "\"", "the end of the file");
  advance(end + closing.size());
  return true;
}

XmlTag XmlScanner::next() {
  do {
    advance(std::min(text_.find('<', at_), text_.size()));
  } while (skip("<?", "?>") || skip("<!--", "-->"));
  XmlTag tag;
  tag.begin = tag.end = at_;
  tag.line = line_;
  tag.column = static_cast<std::int64_t>(at_ - line_begin_) + 1;
  if (at_ >= text_.size()) return tag;
  std::size_t at = at_ + 1;
  tag.closes = at < text_.size() && text_[at] == '/';
  tag.opens = !tag.closes;
  if (tag.closes) ++at;
  tag.name = name_at(text_, at);
  if (tag.name.empty() || tag.name.front() == '!')
    throw error(tag, "the tag of an element", quoted(text_.substr(tag.begin, 9)));
  at = skip_space(text_, at + tag.name.size());
  while (at < text_.size() && text_[at] != '>' && text_[at] != '/') read_attribute(tag, at);
  if (at < text_.size() && text_[at] == '/') {
    tag.closes = true;
    ++at;
  }
  if (at >= text_.size() || text_[at] != '>')
    throw error(tag, "\">\" at the end of the tag " + quoted(tag.name),
                at >= text_.size() ? "the end of the file" : quoted(text_.substr(at, 1)));
  tag.end = at + 1;
  advance(tag.end);
  return tag;
}

void XmlScanner::read_attribute(XmlTag& tag, std::size_t& at) const {
  const std::string_view name = name_at(text_, at);
  std::size_t quote = skip_space(text_, at + name.size());
  const bool equals = !name.empty() && quote < text_.size() && text_[quote] == '=';
  if (equals) quote = skip_space(text_, quote + 1);
  const bool quoted_value = equals && quote < text_.size() && (text_[quote] == '"' || text_[quote] == '\'');
  const std::size_t end = quoted_value ? text_.find(text_[quote], quote + 1) : std::string_view::npos;
  if (end == std::string_view::npos)
    throw error(tag, "attributes such as name=\"value\" in the tag " + quoted(tag.name), quoted(text_.substr(at, 20)));
  tag.attributes.emplace_back(name, unescaped(tag, text_.substr(quote + 1, end - quote - 1)));
  at = skip_space(text_, end + 1);
}

std::string XmlScanner::unescaped(const XmlTag& tag, std::string_view text) const {
  static constexpr std::pair<std::string_view, char> known[] = {
      {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '&') {
      out += text[i];
      continue;
    }
    const std::size_t end = std::min(text.find(';', i), text.size());
    std::string_view name = text.substr(i + 1, end - i - 1);
    const auto* const entity =
        std::find_if(std::begin(known), std::end(known), [&](const auto& k) { return k.first == name; });
    unsigned code = 0;
    if (entity != std::end(known)) {
      out += entity->second;
    } else {
      const int base = name.starts_with("#x") ? 16 : 10;
      name.remove_prefix(std::min<std::size_t>(name.size(), base == 16 ? 2 : 1));
      const auto [at, parsed] = std::from_chars(name.data(), name.data() + name.size(), code, base);
      // Names are hardly ever more than ASCII; what is, stays as it is written.
      if (text[i + 1 < text.size() ? i + 1 : i] != '#' || parsed != std::errc{} || at != name.data() + name.size() ||
          code == 0 || code > 127)
        throw error(tag, "an entity such as &amp; or &#65; in the tag " + quoted(tag.name), quoted(text.substr(i, 10)));
      out += static_cast<char>(code);
    }
    i = end;
  }
  return out;
}

}  // namespace sinew::io
