#include <algorithm>
#include <chrono>
#include <cstdint>
#include <future>
#include <limits>
#include <memory>
#include <utility>

#include "common/av/video_reader.h"
#include "common/base/counted.h"
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

    /// Goes on from one frame of this round to a later one, through a key frame between them if the
    /// file's index has one. At the end of the round next() is empty.
    void go_on(std::uint64_t from, std::uint64_t to) {
        if (from == to) return;
        const std::optional<std::uint64_t> key = round_.reader->key_frame_before(to);
        if (key && *key > from + 1 && is_searchable_) return start_at(to);
        while (from < to && skip()) ++from;
    }

    /// Drops the next frame. Returns false at the end of the round.
    bool skip() { return std::exchange(round_.first, std::nullopt) || round_.reader->skip(1); }

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
        // Matroska's index is read at the first search.
        if (!round.reader->seek(0)) round.reader = std::make_unique<VideoReader>(path);
        round.first = round.reader->next();
        return round;
    }
    /// Makes this frame the next one of the round.
    void start_at(std::uint64_t frame) {
        round_.first.reset();
        if (round_.reader->seek(frame)) return;
        is_searchable_ = false;
        round_.reader = std::make_unique<VideoReader>(path_);
        round_.reader->skip(frame);
    }
    void prepare() {
        upcoming_ = std::async(std::launch::async, [path = path_] { return open(path); });
    }

    std::string path_;
    std::uint64_t length_;
    Round round_;
    std::future<Round> upcoming_;
    bool is_searchable_ = true;
    cv::Size size_;
};

std::uint64_t most_frames_of(const RigConfig::Source& source) {
    return source.frames > 0 ? static_cast<std::uint64_t>(source.frames)
                             : std::numeric_limits<std::uint64_t>::max();
}

class VideoMaterial final : public StereoMaterial {
  public:
    explicit VideoMaterial(const RigConfig::Source& source)
        : loop_(source.loop),
          most_(most_frames_of(source)),
          period_(from_s(1 / source.rate_hz)),
          left_(source.left, loop_) {
        size_ = left_.size();
        length_ = std::clamp<std::uint64_t>(left_.length(), 1, most_);
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
        const MonotonicTime begun = MonotonicClock::now();
        std::optional<StereoPair> pair = loop_ ? looping(pulse_index) : once(pulse_index);
        const MonotonicTime now = MonotonicClock::now();
        // The first frame is decoded already, or searched for.
        if (has_shown_) usual_ = usual_ == 0ns ? now - begun : (4 * usual_ + (now - begun)) / 5;
        has_shown_ = true;
        if (usual_ > period_ && lateness_.count(1, now))
            log_warning(
                "{} is decoded more slowly than pulses come: a frame takes {:.0f} ms and pulses "
                "are "
                "{:.0f} ms apart, so frames are left out to stay in step with other rigs; play "
                "smaller videos or ones with more key frames, or lower rate_hz",
                left_.path(), to_ms(usual_), to_ms(period_));
        return pair;
    }

    std::uint64_t unshown() const override { return unshown_; }

    std::string describe() const override {
        return fmt::format("video {}{}{}", left_.describe(),
                           right_ ? " and " + right_->describe() : ", side by side",
                           loop_ ? ", looping over " + counted(length_, "frame") : "");
    }

  private:
    void begin_again() {
        left_.begin_again();
        if (right_) right_->begin_again();
        position_ = 0;
    }

    /// The frame of this pulse, which is its number modulo the length of a round, so that all rigs
    /// of a stage show frames of one number, however late they are.
    std::optional<StereoPair> looping(std::uint64_t pulse_index) {
        for (;;) {
            go_to(pulse_index % length_);
            std::optional<StereoPair> pair = next();
            if (pair || length_ == 1) return pair;
            // The decoder delivers fewer frames than the file announces: the round ends here.
            length_ = std::max<std::uint64_t>(1, position_ - 1);
            begin_again();
        }
    }

    /// The first pulse shows the first frame; frames of missed pulses are left out.
    std::optional<StereoPair> once(std::uint64_t pulse_index) {
        if (!first_pulse_) first_pulse_ = pulse_index;
        const std::uint64_t wanted = std::min(pulse_index - *first_pulse_, most_);
        unshown_ = 0;
        for (; position_ < wanted; ++position_, ++unshown_)
            if (!left_.skip() || (right_ && !right_->skip())) return std::nullopt;
        return wanted < most_ ? next() : std::nullopt;
    }

    /// Makes this frame of a round the next one. A video that is decoded at the rate of pulses goes
    /// on by one frame at a time; after missed pulses it leaves out as many.
    void go_to(std::uint64_t wanted) {
        if (position_ >= length_ || wanted < position_) begin_again();
        left_.go_on(position_, wanted);
        if (right_) right_->go_on(position_, wanted);
        position_ = wanted;
    }

    /// Next pair; empty once either video has ended.
    std::optional<StereoPair> next() {
        ++position_;
        return decode();
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
    std::uint64_t most_;  ///< frames that are shown of a round
    bool has_shown_ = false;
    std::uint64_t length_ = 0;    ///< of a looping round; the shorter side ends it
    std::uint64_t position_ = 0;  ///< number of the next frame in its round
    std::chrono::nanoseconds period_;
    std::chrono::nanoseconds usual_{0};         ///< smoothed time that a frame takes; 0: unknown
    std::optional<std::uint64_t> first_pulse_;  ///< without looping
    std::uint64_t unshown_ = 0;                 ///< without looping, left out before the end
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
