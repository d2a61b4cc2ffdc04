#include "host_app/ltc/ltc_sound.h"

#include <cmath>
#include <cstdlib>

#include <ltc.h>

#include "common/av/sound.h"
#include "common/base/error.h"

namespace vantage {
namespace {

/// The frame rate from which libltc starts: slightly lower than most.
constexpr int first_guess_hz = 25, queue_frames = 32;
/// Accepted rates: 24 to 30 per second with a tenth on either side, since tapes drift.
constexpr double least_rate_hz = 21.5, most_rate_hz = 33;

std::optional<LtcReading> reading_of(const LTCFrameExt& frame, int rate_hz) {
    // Values beyond a decimal digit are not a code.
    const LTCFrame& bits = frame.ltc;
    const unsigned digits[] = {bits.frame_units, bits.secs_units, bits.mins_units,
                               bits.hours_units};
    for (const unsigned digit : digits)
        if (digit > 9) return std::nullopt;
    LtcReading reading;
    reading.code = {static_cast<int>(10 * bits.hours_tens + bits.hours_units),
                    static_cast<int>(10 * bits.mins_tens + bits.mins_units),
                    static_cast<int>(10 * bits.secs_tens + bits.secs_units),
                    static_cast<int>(10 * bits.frame_tens + bits.frame_units), bits.dfbit != 0};
    reading.first = frame.off_start;
    const double length = static_cast<double>(frame.off_end - frame.off_start + 1);
    reading.frames_a_second = length > 0 ? rate_hz / length : 0;
    const bool is_code = frame.reverse == 0 && reading.frames_a_second > least_rate_hz &&
                         reading.frames_a_second < most_rate_hz && reading.code.hours < 24 &&
                         reading.code.minutes < 60 && reading.code.seconds < 60 &&
                         count_of(reading).frame_of(reading.code);
    return is_code ? std::optional(reading) : std::nullopt;
}

}  // namespace

void LtcReader::Deleter::operator()(LTCDecoder* decoder) const { ltc_decoder_free(decoder); }

LtcReader::LtcReader(int rate_hz)
    : rate_hz_(rate_hz), decoder_(ltc_decoder_create(rate_hz / first_guess_hz, queue_frames)) {
    if (!decoder_) fail("cannot read linear time code: out of memory");
}

std::vector<LtcReading> LtcReader::hear(const SoundBlock& sound) {
    std::vector<float> left;
    for (std::size_t i = 0; i < sound.samples.size(); i += sound_channels)
        left.push_back(sound.samples[i]);
    return hear(left, sound.first);
}

std::vector<LtcReading> LtcReader::hear(std::span<const float> channel, std::int64_t first) {
    std::vector<float> finite;
    for (const float sample : channel)
        finite.push_back(std::isfinite(sample) ? std::clamp(sample, -1.0F, 1.0F) : 0.0F);
    std::vector<LtcReading> readings;
    // libltc accepts a thousand samples at a time and queues a limited number of frames.
    constexpr std::size_t at_once = 1024;
    for (std::size_t at = 0; at < finite.size(); at += at_once) {
        ltc_decoder_write_float(decoder_.get(), finite.data() + at,
                                std::min(at_once, finite.size() - at),
                                first + static_cast<std::int64_t>(at));
        LTCFrameExt frame{};
        while (ltc_decoder_read(decoder_.get(), &frame) > 0) {
            const std::optional<LtcReading> reading = reading_of(frame, rate_hz_);
            const std::optional<LtcReading> before = std::exchange(last_, reading);
            if (!reading) {
                ++malformed_;
                continue;
            }
            const SmpteCount count = count_of(*reading);
            const bool follows =
                before && before->code.is_drop_frame == reading->code.is_drop_frame &&
                count.frame_of(before->code) &&
                count.between(*count.frame_of(reading->code), *count.frame_of(before->code)) == 1;
            if (follows)
                readings.push_back(*reading);
            else if (before)
                ++malformed_;
        }
    }
    return readings;
}

SmpteCount count_of(const LtcReading& reading) {
    if (reading.code.is_drop_frame || reading.frames_a_second > 27.5)
        return {30, reading.code.is_drop_frame};
    return {reading.frames_a_second > 24.5 ? 25 : 24, false};
}

void LtcWriter::Deleter::operator()(LTCEncoder* encoder) const { ltc_encoder_free(encoder); }

LtcWriter::LtcWriter(double rate_hz)
    // libltc selects drop-frame code by the rate 29.97.
    : encoder_(
          ltc_encoder_create(sound_rate_hz, rate_hz > 29 && rate_hz < 30 ? 30000.0 / 1001 : rate_hz,
                             rate_hz > 24.5 && rate_hz < 25.5 ? LTC_TV_625_50 : LTC_TV_525_60, 0)) {
    if (!encoder_) fail("cannot generate linear time code: out of memory");
    constexpr double level_dbfs = -12;
    ltc_encoder_set_volume(encoder_.get(), level_dbfs);
}

std::vector<float> LtcWriter::frame(const SmpteCode& code) {
    SMPTETimecode time{};
    time.hours = static_cast<unsigned char>(code.hours);
    time.mins = static_cast<unsigned char>(code.minutes);
    time.secs = static_cast<unsigned char>(code.seconds);
    time.frame = static_cast<unsigned char>(code.frame);
    ltc_encoder_set_timecode(encoder_.get(), &time);
    ltc_encoder_encode_frame(encoder_.get());
    ltcsnd_sample_t* bytes = nullptr;
    const int count = ltc_encoder_get_bufferptr(encoder_.get(), &bytes, 1);
    std::vector<float> samples;
    constexpr float middle = 128;
    for (int i = 0; i < count; ++i)
        samples.push_back((static_cast<float>(bytes[i]) - middle) / middle);
    return samples;
}

std::optional<SmpteCode> LtcFlywheel::next(const std::optional<SmpteCode>& picture) {
    const std::optional<std::int64_t> shown = picture ? count_.frame_of(*picture) : std::nullopt;
    if (shown) {
        stood_ = shown == last_picture_ ? stood_ + 1 : 0;
        last_picture_ = shown;
        const std::int64_t second = count_.numbers_a_second;
        const bool is_elsewhere = next_ && std::abs(count_.between(*shown, *next_)) > second / 4;
        if (!next_ || is_elsewhere || stood_ >= second) {
            jumps_ += is_elsewhere && stood_ < second;
            next_ = shown;
        }
    }
    if (!next_) return std::nullopt;
    return count_.code_of((*next_)++);
}

}  // namespace vantage
