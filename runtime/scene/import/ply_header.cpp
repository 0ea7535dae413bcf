#include "runtime/scene/import/ply_header.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <unordered_set>

#include "runtime/scene/import/refuse.h"

namespace voyager::ply {
namespace {

constexpr size_t kMaxLine = 4096, kMaxHeader = 256 * 1024;

struct TypeName {
  std::string_view name, sized_name;
  Type type;
  size_t size;
};
constexpr TypeName kTypes[] = {
    {"char", "int8", Type::i8, 1},      {"uchar", "uint8", Type::u8, 1},
    {"short", "int16", Type::i16, 2},   {"ushort", "uint16", Type::u16, 2},
    {"int", "int32", Type::i32, 4},     {"uint", "uint32", Type::u32, 4},
    {"float", "float32", Type::f32, 4}, {"double", "float64", Type::f64, 8},
};

std::string in_quotes(std::string_view text) {
  return "\"" + std::string(text.substr(0, 80)) + "\"";
}

class Parser {
 public:
  explicit Parser(PeekReader& input) : input_(input), start_(input.offset()) {}

  Header parse() {
    next_line();
    if (line_ != "ply") refuse_line("first line", "\"ply\"");
    for (next_line(); line_ != "end_header"; next_line()) {
      const std::string_view keyword = words_.empty() ? std::string_view() : words_[0];
      if (keyword == "obj_info") continue;
      if (keyword == "comment")
        comment();
      else if (keyword == "format")
        format();
      else if (keyword == "element")
        element();
      else if (keyword == "property")
        property();
      else
        refuse_line("header line", "format, element, property, comment, obj_info or end_header");
    }
    check();
    return std::move(header_);
  }

 private:
  [[noreturn]] void refuse_line(const std::string& field, const std::string& expected) const {
    refuse(input_.name(), line_start_, field, in_quotes(line_), expected);
  }

  // What trainers write of their filter; other comments are free text.
  void comment() {
    if (words_.size() != 3) return;
    const bool brush = words_[1] == "SplatRenderMode:" || words_[1] == "SplatRenderMode";
    if (brush && words_[2] == "mip") header_.native = compensated_scale(kMipSplattingLowPass);
    if (words_[1] == "antialiased" && words_[2] == "1")
      header_.native = compensated_scale(kLowPass);
  }

  void next_line() {
    line_start_ = input_.offset();
    const std::span<const std::byte> ahead = input_.peek(kMaxLine);
    const auto end = std::find(ahead.begin(), ahead.end(), std::byte{'\n'});
    const size_t length = static_cast<size_t>(end - ahead.begin());
    line_.assign(reinterpret_cast<const char*>(ahead.data()), length);
    if (end == ahead.end())
      refuse_line("header line", ahead.size() < kMaxLine ? "a newline before the end of the file"
                                                         : "at most 4096 bytes a line");
    input_.skip(length + 1);
    if (!line_.empty() && line_.back() == '\r') line_.pop_back();
    if (input_.offset() - start_ > kMaxHeader) refuse_line("header", "at most 256 KiB");
    split();
  }

  void split() {
    words_.clear();
    const std::string_view line = line_;
    for (size_t at = 0; at < line.size();) {
      const size_t begin = std::min(line.find_first_not_of(" \t", at), line.size());
      at = std::min(line.find_first_of(" \t", begin), line.size());
      if (at > begin) words_.push_back(line.substr(begin, at - begin));
    }
  }

  void format() {
    if (words_.size() != 3 || words_[2] != "1.0") refuse_line("format", "version 1.0");
    if (has_format_) refuse_line("format", "one format line");
    has_format_ = true;
    header_.big_endian = words_[1] == "binary_big_endian";
    if (!header_.big_endian && words_[1] != "binary_little_endian")
      refuse_line("format", "binary_little_endian or binary_big_endian");
  }

  void element() {
    Element element;
    const std::string_view digits = words_.size() == 3 ? words_[2] : std::string_view();
    const auto [end, problem] =
        std::from_chars(digits.data(), digits.data() + digits.size(), element.count);
    if (digits.empty() || problem != std::errc() || end != digits.data() + digits.size())
      refuse_line("element", "a name and a count below 2^64");
    element.name = words_[1];
    if (!elements_.insert(element.name).second) refuse_line("element", "each name once");
    properties_.clear();
    header_.elements.push_back(std::move(element));
  }

  void property() {
    if (header_.elements.empty()) refuse_line("property", "an element line before it");
    Element& element = header_.elements.back();
    if (words_.size() == 5 && words_[1] == "list") {
      element.has_list = true;
      if (!vertex_seen_before_last()) refuse_line("property", kScalars);
      return;
    }
    const std::string_view type = words_.size() == 3 ? words_[1] : std::string_view();
    const auto known = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const TypeName& t) {
      return t.name == type || t.sized_name == type;
    });
    if (known == std::end(kTypes)) refuse_line("property", kScalars);
    const std::string name(words_[2]);
    if (!properties_.insert(name).second) refuse_line("property", "each name once in an element");
    element.properties.push_back({name, known->type, element.stride});
    element.stride += known->size;
  }

  // Lists are harmless only after the vertex element, where nothing is read.
  bool vertex_seen_before_last() const {
    for (size_t i = 0; i + 1 < header_.elements.size(); ++i)
      if (header_.elements[i].name == "vertex") return true;
    return false;
  }

  void check() {
    if (!has_format_) refuse_line("header", "a format line before it");
    for (; header_.vertex < header_.elements.size(); ++header_.vertex)
      if (header_.elements[header_.vertex].name == "vertex") return;
    refuse_line("header", "an element named vertex before it");
  }

  static constexpr const char* kScalars =
      "a scalar type (char to double, int8 to float64) and a name; no list in or before vertex";

  PeekReader& input_;
  uint64_t start_, line_start_ = 0;
  std::string line_;
  std::vector<std::string_view> words_;  // of line_
  Header header_;
  bool has_format_ = false;
  // Names so far, of the properties those of the last element: there may be ten thousand.
  std::unordered_set<std::string> elements_, properties_;
};

}  // namespace

size_t size_of(Type type) {
  return kTypes[static_cast<size_t>(type)].size;
}

const Property* Element::find(const std::string& property) const {
  const auto found = std::find_if(properties.begin(), properties.end(),
                                  [&](const Property& p) { return p.name == property; });
  return found == properties.end() ? nullptr : &*found;
}

Header read_header(PeekReader& input) {
  return Parser(input).parse();
}

}  // namespace voyager::ply
