#include "host_app/ltc/ltc_reader.h"

#include <cmath>
#include <cstdlib>

#include <ltc.h>

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

}  // namespace vantage
