#include <future>
#include <memory>
#include <utility>

#include "common/base/error.h"
#include "rig_firmware/capture/material/stereo_material.h"
#include "rig_firmware/capture/material/video_reader.h"

namespace vantage {
namespace {

/// Video that can restart any number of times. A separate thread opens the next round and decodes
/// its first frame while this one plays, so that no pulse waits for it.
class VideoRounds {
  public:
    VideoRounds(std::string path, bool loop) : path_(std::move(path)), round_(open(path_)) {
        if (!round_.first) fail("{} holds no picture", path_);
        size_ = round_.first->size();
        if (loop) prepare();
    }

    /// Next frame; empty at the end of a round.
    std::optional<ColourImage> next() {
        std::optional<ColourImage> picture = std::exchange(round_.first, std::nullopt);
        if (!picture) picture = round_.reader->next();
        if (picture && picture->size() != size_)
            fail("{} changes its size from {}x{} to {}x{}: all its pictures must have one", path_,
                 size_.width, size_.height, picture->cols, picture->rows);
        return picture;
    }

    /// Starts the next round of a looping video.
    void begin_again() {
        round_ = upcoming_.get();
        prepare();
    }

    const std::string& path() const { return path_; }
    cv::Size size() const { return size_; }
    double rate_hz() const { return round_.reader->rate_hz(); }
    std::string describe() const {
        const std::string rate = rate_hz() > 0 ? fmt::format(", {:.4g} Hz", rate_hz()) : "";
        return fmt::format("{} ({}{})", path_, round_.reader->codec_name(), rate);
    }

  private:
    struct Round {
        std::unique_ptr<VideoReader> reader;
        std::optional<ColourImage> first;
    };
    static Round open(const std::string& path) {
        Round round{std::make_unique<VideoReader>(path), {}};
        round.first = round.reader->next();
        return round;
    }
    void prepare() {
        upcoming_ = std::async(std::launch::async, [path = path_] { return open(path); });
    }

    std::string path_;
    Round round_;
    std::future<Round> upcoming_;
    cv::Size size_;
};

class VideoMaterial final : public StereoMaterial {
  public:
    explicit VideoMaterial(const RigConfig::Source& source)
        : loop_(source.loop), left_(source.left, loop_) {
        size_ = left_.size();
        if (source.right.empty()) {
            size_.width /= 2;
            return;
        }
        right_ = std::make_unique<VideoRounds>(source.right, loop_);
        if (right_->size() != size_)
            fail("{} is {}x{} and {} is {}x{}: both videos of a pair must have one size",
                 source.left, size_.width, size_.height, source.right, right_->size().width,
                 right_->size().height);
    }

    cv::Size size() const override { return size_; }
    double rate_hz() const override { return left_.rate_hz(); }

    std::optional<StereoPair> pair_of(std::uint64_t) override {
        std::optional<StereoPair> pair = next();
        if (pair || !loop_) return pair;
        left_.begin_again();
        if (right_) right_->begin_again();
        return next();
    }

    std::string describe() const override {
        return fmt::format("video {}{}{}", left_.describe(),
                           right_ ? " and " + right_->describe() : ", side by side",
                           loop_ ? ", looping" : "");
    }

  private:
    /// Next pair; empty once either video has ended.
    std::optional<StereoPair> next() {
        std::optional<ColourImage> left = left_.next();
        if (!left) return std::nullopt;
        if (!right_) return split_side_by_side(*left, left_.path());
        std::optional<ColourImage> right = right_->next();
        if (!right) return std::nullopt;
        return StereoPair{std::move(*left), std::move(*right)};
    }

    bool loop_;
    VideoRounds left_;
    std::unique_ptr<VideoRounds> right_;  ///< null: side by side
    cv::Size size_;
};

}  // namespace

std::unique_ptr<StereoMaterial> open_video(const RigConfig::Source& source) {
    return std::make_unique<VideoMaterial>(source);
}

}  // namespace vantage
