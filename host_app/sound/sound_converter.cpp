#include "host_app/sound/sound_converter.h"

#include <algorithm>

#include "common/base/error.h"

namespace vantage {

SoundConverter::SoundConverter(AVChannelLayout channels, AVSampleFormat format, int rate_hz) {
    AVChannelLayout stereo{};
    av_channel_layout_default(&stereo, static_cast<int>(sound_channels));
    SwrContext* context = nullptr;
    int code = swr_alloc_set_opts2(&context, &stereo, AV_SAMPLE_FMT_FLT, sound_rate_hz, &channels,
                                   format, rate_hz, 0, nullptr);
    context_.reset(context);
    if (code >= 0) code = swr_init(context);
    if (code < 0)
        fail("sound of {} channels at {} Hz cannot be converted ({})", channels.nb_channels,
             rate_hz, av_reason(code));
}

std::vector<float> SoundConverter::convert(const std::uint8_t* const* planes, int count) {
    const int most = swr_get_out_samples(context_.get(), count);
    std::vector<float> samples(static_cast<std::size_t>(std::max(0, most)) * sound_channels);
    auto* out = reinterpret_cast<std::uint8_t*>(samples.data());
    const int made =
        swr_convert(context_.get(), &out, most, const_cast<const std::uint8_t**>(planes), count);
    if (made < 0) fail("sound cannot be converted ({})", av_reason(made));
    samples.resize(static_cast<std::size_t>(made) * sound_channels);
    return samples;
}

}  // namespace vantage
