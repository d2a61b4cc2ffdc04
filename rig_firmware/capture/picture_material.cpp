#include <optional>

#include "common/base/error.h"
#include "common/image/image_file.h"
#include "rig_firmware/capture/numbered_files.h"
#include "rig_firmware/capture/stereo_material.h"

namespace vantage {
namespace {

StereoPair read_pair(const std::filesystem::path& left, const std::filesystem::path& right) {
    if (right.empty()) return split_side_by_side(read_colour_image(left), left.string());
    StereoPair pair{read_colour_image(left), read_colour_image(right)};
    if (pair.left.size() != pair.right.size())
        fail("{} is {}x{} and {} is {}x{}: both pictures of a pair must have one size",
             left.string(), pair.left.cols, pair.left.rows, right.string(), pair.right.cols,
             pair.right.rows);
    return pair;
}

class SinglePair final : public StereoMaterial {
  public:
    explicit SinglePair(const RigConfig::Source& source)
        : pair_(read_pair(source.left, source.right)), loop_(source.loop) {
        description_ = source.right.empty() ? source.left + ", side by side"
                                            : source.left + " and " + source.right;
    }

    cv::Size size() const override { return pair_.left.size(); }
    std::optional<StereoPair> pair_of(std::uint64_t) override {
        if (shown_ && !loop_) return std::nullopt;
        shown_ = true;
        return pair_;
    }
    std::string describe() const override { return description_ + (loop_ ? ", looping" : ""); }

  private:
    StereoPair pair_;
    bool loop_;
    bool shown_ = false;
    std::string description_;
};

class NumberedPairs final : public StereoMaterial {
  public:
    explicit NumberedPairs(const RigConfig::Source& source)
        : left_(source.left), first_(source.first), loop_(source.loop) {
        count_ = left_.count_from(first_);
        if (!source.right.empty()) {
            if (!NumberedFiles::is_pattern(source.right))
                fail(
                    "'left' names numbered pictures and 'right' a single one, {}: give both a "
                    "number, or none",
                    source.right);
            right_.emplace(source.right);
            const int right_count = right_->count_from(first_);
            if (right_count != count_)
                fail(
                    "there are {} left pictures from {} on and {} right ones: every left one needs "
                    "its right one",
                    count_, left_.path(first_).string(), right_count);
        }
        size_ = read(0).left.size();
    }

    cv::Size size() const override { return size_; }

    std::optional<StereoPair> pair_of(std::uint64_t pulse_index) override {
        if (!first_pulse_) first_pulse_ = loop_ ? 0 : pulse_index;
        const std::uint64_t position = pulse_index - *first_pulse_;
        const auto count = static_cast<std::uint64_t>(count_);
        if (!loop_ && position >= count) return std::nullopt;
        return read(static_cast<int>(position % count));
    }

    std::string describe() const override {
        return fmt::format("{} pairs from {} on{}{}", count_, left_.path(first_).string(),
                           right_ ? "" : ", side by side", loop_ ? ", looping" : "");
    }

  private:
    StereoPair read(int position) const {
        const int number = first_ + position;
        const std::filesystem::path left = left_.path(number);
        StereoPair pair = read_pair(left, right_ ? right_->path(number) : std::filesystem::path());
        if (!size_.empty() && pair.left.size() != size_)
            fail("{} shows {}x{} pictures and those before it {}x{}: all must have one size",
                 left.string(), pair.left.cols, pair.left.rows, size_.width, size_.height);
        return pair;
    }

    NumberedFiles left_;
    std::optional<NumberedFiles> right_;
    int first_, count_ = 0;
    bool loop_;
    cv::Size size_;
    std::optional<std::uint64_t> first_pulse_;
};

}  // namespace

std::unique_ptr<StereoMaterial> open_pictures(const RigConfig::Source& source) {
    if (NumberedFiles::is_pattern(source.left)) return std::make_unique<NumberedPairs>(source);
    if (NumberedFiles::is_pattern(source.right))
        fail(
            "'right' names numbered pictures and 'left' a single one, {}: give both a number, or "
            "none",
            source.left);
    return std::make_unique<SinglePair>(source);
}

}  // namespace vantage
