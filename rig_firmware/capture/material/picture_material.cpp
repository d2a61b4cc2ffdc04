#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/counted.h"
#include "common/base/error.h"
#include "common/image/image_file.h"
#include "common/image/picture_list.h"
#include "rig_firmware/capture/material/numbered_files.h"
#include "rig_firmware/capture/material/stereo_material.h"

namespace vantage {
namespace {

/// Number of images of a series that are sampled for their range of values before playback.
constexpr std::size_t range_samples = 16;

StereoPair read_pair(const std::filesystem::path& left, const std::filesystem::path& right,
                     CodeRange& range) {
    if (right.empty()) return split_side_by_side(read_colour_image(left, range), left.string());
    StereoPair pair;
    pair.left = read_colour_image(left, range);
    pair.right = read_colour_image(right, range);
    if (pair.left.size() != pair.right.size())
        fail("{} is {}x{} and {} is {}x{}: both pictures of a pair must have one size",
             left.string(), pair.left.cols, pair.left.rows, right.string(), pair.right.cols,
             pair.right.rows);
    return pair;
}

StereoPair read_single_pair(const std::filesystem::path& left, const std::filesystem::path& right) {
    std::vector<std::filesystem::path> files{left};
    if (!right.empty()) files.push_back(right);
    CodeRange range = common_code_range(files, files.size());
    return read_pair(left, right, range);
}

class SinglePair final : public StereoMaterial {
  public:
    explicit SinglePair(const RigConfig::Source& source)
        : pair_(read_single_pair(source.left, source.right)), loop_(source.loop) {
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

using PairFiles = std::vector<std::pair<std::filesystem::path, std::filesystem::path>>;

/// Series of image pairs, one file per side; an empty right name means side-by-side images.
class PairSeries final : public StereoMaterial {
  public:
    PairSeries(PairFiles files, const RigConfig::Source& source)
        : files_(std::move(files)), loop_(source.loop) {
        if (source.frames > 0)
            files_.resize(std::min(files_.size(), static_cast<std::size_t>(source.frames)));
        std::vector<std::filesystem::path> names;
        for (const auto& [left, right] : files_) {
            names.push_back(left);
            if (!right.empty()) names.push_back(right);
        }
        range_ = common_code_range(names, range_samples);
        size_ = read(0).left.size();
    }

    cv::Size size() const override { return size_; }

    std::optional<StereoPair> pair_of(std::uint64_t pulse_index) override {
        if (!first_pulse_) first_pulse_ = loop_ ? 0 : pulse_index;
        const std::uint64_t position = pulse_index - *first_pulse_;
        if (!loop_ && position >= files_.size()) return std::nullopt;
        shown_to_ = position + 1;
        return read(position % files_.size());
    }
    std::uint64_t unshown() const override { return loop_ ? 0 : files_.size() - shown_to_; }

    std::string describe() const override {
        const auto& [left, right] = files_.front();
        return fmt::format("{} from {} on{}{}", counted(files_.size(), "pair"), left.string(),
                           right.empty() ? ", side by side" : "", loop_ ? ", looping" : "");
    }

  private:
    StereoPair read(std::uint64_t position) {
        const auto& [left, right] = files_[position];
        StereoPair pair = read_pair(left, right, range_);
        if (!size_.empty() && pair.left.size() != size_)
            fail("{} shows {}x{} pictures and those before it {}x{}: all must have one size",
                 left.string(), pair.left.cols, pair.left.rows, size_.width, size_.height);
        return pair;
    }

    PairFiles files_;
    bool loop_;
    CodeRange range_;
    cv::Size size_;
    std::optional<std::uint64_t> first_pulse_;
    std::uint64_t shown_to_ = 0;  ///< index after the last pair shown
};

PairFiles numbered_pairs(const RigConfig::Source& source) {
    const NumberedFiles left(source.left);
    const int count = left.count_from(source.first);
    std::optional<NumberedFiles> right;
    if (!source.right.empty()) {
        if (!NumberedFiles::is_pattern(source.right))
            fail(
                "'left' names numbered pictures and 'right' a single one, {}: give both a number, "
                "or none",
                source.right);
        right.emplace(source.right);
        const int right_count = right->count_from(source.first);
        if (right_count != count)
            fail(
                "there are {} left pictures from {} on and {} right ones: every left one needs its "
                "right one",
                count, left.path(source.first).string(), right_count);
    }
    PairFiles files;
    for (int number = source.first; number < source.first + count; ++number)
        files.emplace_back(left.path(number),
                           right ? right->path(number) : std::filesystem::path());
    return files;
}

PairFiles listed_pairs(const RigConfig::Source& source) {
    const std::vector<std::filesystem::path> left = expand_pictures(source.left);
    if (source.right.empty()) {
        PairFiles files;
        for (const std::filesystem::path& file : left) files.emplace_back(file, "");
        return files;
    }
    PicturePairs pairs = pair_pictures(left, expand_pictures(source.right));
    if (!pairs.alone.empty())
        fail(
            "{} has no partner of the same number on the other side: every left picture needs its "
            "right one",
            pairs.alone.front().string());
    return std::move(pairs.pairs);
}

}  // namespace

std::unique_ptr<StereoMaterial> open_pictures(const RigConfig::Source& source) {
    if (is_list(source.left) || is_list(source.right))
        return std::make_unique<PairSeries>(listed_pairs(source), source);
    if (NumberedFiles::is_pattern(source.left))
        return std::make_unique<PairSeries>(numbered_pairs(source), source);
    if (NumberedFiles::is_pattern(source.right))
        fail(
            "'right' names numbered pictures and 'left' a single one, {}: give both a number, or "
            "none",
            source.left);
    return std::make_unique<SinglePair>(source);
}

}  // namespace vantage
