#include "host_app/ltc/ltc_writer.h"

#include <cstdlib>

#include <ltc.h>

#include "common/av/sound.h"
#include "common/base/error.h"

namespace vantage {

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
