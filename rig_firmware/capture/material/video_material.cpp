#include <algorithm>
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <utility>

#include "common/av/video_reader.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/log_limiter.h"
#include "common/base/time/time.h"
#include "rig_firmware/capture/material/stereo_material.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

/// Video that can restart any number of times. A separate thread opens the next round and decodes
/// its first frame while this one plays, so that no pulse waits for it.
class VideoRounds {
  public:
    VideoRounds(std::string path, bool loop)
        : path_(std::move(path)),
          length_(loop ? VideoReader(path_).count() : 0),
          round_(open(path_)) {
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

    /// Makes this frame the next one of the first round.
    void start_at(std::uint64_t frame) {
        if (frame == 0) return;
        round_.first.reset();
        if (round_.reader->seek(frame)) return;
        round_.reader = std::make_unique<VideoReader>(path_);
        round_.reader->skip(frame);
    }

    /// Drops frames of this round. Returns false if it ends before them.
    bool skip(std::uint64_t frames) {
        if (frames > 0 && std::exchange(round_.first, std::nullopt)) --frames;
        return round_.reader->skip(frames);
    }

    /// Starts the next round of a looping video.
    void begin_again() {
        round_ = upcoming_.get();
        prepare();
    }

    const std::string& path() const { return path_; }
    cv::Size size() const { return size_; }
    /// Frames of a round of a looping video.
    std::uint64_t length() const { return length_; }
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
    std::uint64_t length_;
    Round round_;
    std::future<Round> upcoming_;
    cv::Size size_;
};

class VideoMaterial final : public StereoMaterial {
  public:
    explicit VideoMaterial(const RigConfig::Source& source)
        : loop_(source.loop), period_(from_s(1 / source.rate_hz)), left_(source.left, loop_) {
        size_ = left_.size();
        length_ = std::max<std::uint64_t>(1, left_.length());
        if (source.right.empty()) {
            size_.width /= 2;
            return;
        }
        right_ = std::make_unique<VideoRounds>(source.right, loop_);
        if (right_->size() != size_)
            fail("{} is {}x{} and {} is {}x{}: both videos of a pair must have one size",
                 source.left, size_.width, size_.height, source.right, right_->size().width,
                 right_->size().height);
        if (loop_) length_ = std::clamp<std::uint64_t>(right_->length(), 1, length_);
    }

    cv::Size size() const override { return size_; }
    double rate_hz() const override { return left_.rate_hz(); }

    std::optional<StereoPair> pair_of(std::uint64_t pulse_index) override {
        if (!loop_) return next();
        catch_up(pulse_index);
        ++position_;
        if (std::optional<StereoPair> pair = next()) return pair;
        // The decoder delivers fewer frames than the file announces: the round ends here.
        length_ = std::max<std::uint64_t>(1, position_ - 1);
        begin_again();
        position_ = 1;
        return next();
    }

    std::string describe() const override {
        return fmt::format("video {}{}{}", left_.describe(),
                           right_ ? " and " + right_->describe() : ", side by side",
                           loop_ ? ", looping" : "");
    }

  private:
    void begin_again() {
        left_.begin_again();
        if (right_) right_->begin_again();
        position_ = 0;
    }

    /// Moves on to the frame of this pulse, which is its number modulo the length of a round, so
    /// that all rigs of a stage show frames of one number. After missed pulses it drops as many
    /// frames as are decoded within one period. A computer that decodes more slowly than the pulses
    /// drops none: it would fall behind without limit, and plays more slowly instead.
    void catch_up(std::uint64_t pulse_index) {
        const std::uint64_t wanted = pulse_index % length_;
        if (position_ >= length_) begin_again();
        if (!std::exchange(has_started_, true)) {
            left_.start_at(wanted);
            if (right_) right_->start_at(wanted);
            position_ = wanted;
            return;
        }
        const std::uint64_t late = (wanted + length_ - position_) % length_;
        std::uint64_t behind = std::min(droppable(), late);
        if (late > behind && lateness_.count(1, MonotonicClock::now()))
            log_warning(
                "{} is decoded more slowly than pulses come: this frame is {} behind its pulse, so "
                "that rigs with other videos show other moments; play smaller videos, or lower "
                "rate_hz",
                left_.path(), late - behind);
        if (position_ + behind >= length_) {
            behind = position_ + behind - length_;
            begin_again();
        }
        left_.skip(behind);
        if (right_) right_->skip(behind);
        position_ += behind;
    }

    /// Frames that can be decoded within one period beside the one that is shown.
    std::uint64_t droppable() const {
        constexpr std::int64_t most = 100;
        return static_cast<std::uint64_t>(
            std::clamp<std::int64_t>(period_ / std::max(decoding_, 1ns) - 1, 0, most));
    }

    /// Next pair; empty once either video has ended.
    std::optional<StereoPair> next() {
        const MonotonicTime begun = MonotonicClock::now();
        std::optional<StereoPair> pair = decode();
        // The first frame of a round and the one after a search are decoded already.
        constexpr std::uint64_t decoded_already = 2;
        const std::chrono::nanoseconds taken = MonotonicClock::now() - begun;
        if (++decoded_ > decoded_already && position_ > 1)
            decoding_ = decoding_ == 0ns ? taken : (4 * decoding_ + taken) / 5;
        return pair;
    }

    std::optional<StereoPair> decode() {
        std::optional<ColourImage> left = left_.next();
        if (!left) return std::nullopt;
        if (!right_) return split_side_by_side(*left, left_.path());
        std::optional<ColourImage> right = right_->next();
        if (!right) return std::nullopt;
        return StereoPair{std::move(*left), std::move(*right)};
    }

    bool loop_;
    bool has_started_ = false;
    std::uint64_t length_ = 0;    ///< of a looping round; the shorter side ends it
    std::uint64_t position_ = 0;  ///< number of the next frame in its round
    std::chrono::nanoseconds period_;
    std::chrono::nanoseconds decoding_{0};  ///< smoothed time that a pair takes; 0: not known yet
    std::uint64_t decoded_ = 0;
    LogLimiter lateness_{10s};
    VideoRounds left_;
    std::unique_ptr<VideoRounds> right_;  ///< null: side by side
    cv::Size size_;
};

}  // namespace

std::unique_ptr<StereoMaterial> open_video(const RigConfig::Source& source) {
    return std::make_unique<VideoMaterial>(source);
}

}  // namespace vantage
