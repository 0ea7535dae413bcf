#include <fmt/core.h>

#include <array>
#include <charconv>

#include "tools/training_cameras/colmap.h"

namespace voyager::tools {
namespace {

constexpr size_t kLongestLine = 1 << 14;

// The lines of a file, and of each its words.
class Lines {
 public:
  explicit Lines(const ByteSource& file) : bytes_(file) {}

  // The next one that is neither empty nor a comment, if any.
  bool next() {
    while (bytes_.left() > 0) {
      line_.clear();
      bytes_.skip_past('\n', &line_, kLongestLine + 1);
      ++number_;
      words_ = line_;
      if (line_.size() > kLongestLine)
        refuse_cameras(place(), "more than 16384 bytes", "a shorter line");
      if (const std::string_view first = word(); !first.empty() && first.front() != '#') {
        words_ = line_;
        return true;
      }
    }
    return false;
  }
  // Steps over the next one, whatever it is.
  void skip() {
    bytes_.skip_past('\n');
    ++number_;
  }

  std::string place() const { return fmt::format("{}: line {}", bytes_.name(), number_); }

  // Of the line; empty behind its last.
  std::string_view word() {
    constexpr std::string_view kSpace = " \t\r\v\f";
    words_.remove_prefix(std::min(words_.find_first_not_of(kSpace), words_.size()));
    const std::string_view found = words_.substr(0, words_.find_first_of(kSpace));
    words_.remove_prefix(found.size());
    return found;
  }
  template <class T>
  T number(const char* what) {
    const std::string_view text = word();
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc{} || end != text.data() + text.size())
      refuse_cameras(place(), text.empty() ? "the end of the line" : std::string(excerpt(text)),
                     what);
    return value;
  }

 private:
  ByteWindow bytes_;
  uint64_t number_ = 0;
  std::string line_;
  std::string_view words_;  // of line_, those that are left
};

void read_lens(Lines& lines, ColmapLenses& lenses) {
  const auto id = lines.number<uint32_t>("a CAMERA_ID");
  const ColmapModel& model = colmap_model(lines.place(), lines.word());
  const auto width = lines.number<uint64_t>("a WIDTH");
  const auto height = lines.number<uint64_t>("a HEIGHT");
  std::array<double, kMostColmapParameters> parameters{};
  for (size_t i = 0; i < model.parameters; ++i)
    parameters[i] = lines.number<double>("a number in PARAMS");
  add_lens(lenses, lines.place(), id, model, width, height,
           std::span(parameters).first(model.parameters));
}

TrainingCamera read_image(Lines& lines, const ColmapLenses& lenses) {
  lines.number<uint32_t>("an IMAGE_ID");
  std::array<double, 7> pose{};
  for (double& value : pose) value = lines.number<double>("a number of an image's pose");
  const auto lens = lines.number<uint32_t>("a CAMERA_ID");
  return colmap_camera(lenses, lines.place(), lens, pose);
}

}  // namespace

ColmapLenses read_lenses_text(const ByteSource& file) {
  ColmapLenses lenses;
  for (Lines lines(file); lines.next();) read_lens(lines, lenses);
  return lenses;
}

std::vector<TrainingCamera> read_images_text(const ByteSource& file, const ColmapLenses& lenses) {
  std::vector<TrainingCamera> cameras;
  // The line after an image has its points, and is there also where it has none.
  for (Lines lines(file); lines.next(); lines.skip()) cameras.push_back(read_image(lines, lenses));
  return cameras;
}

}  // namespace voyager::tools
