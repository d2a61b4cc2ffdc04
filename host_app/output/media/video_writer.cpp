#include "host_app/output/media/video_writer.h"

#include <cassert>

#include "common/base/error.h"

namespace vantage {

VideoWriter::VideoWriter(std::filesystem::path path, const VideoSettings& settings)
    : file_(std::move(path)) {
    if (settings.width_px < 2 || settings.height_px < 2)
        fail("{} cannot be written: a film of {}x{} pixels is too small", file_.path().string(),
             settings.width_px, settings.height_px);
    try {
        encoder_.emplace(settings.encoder, EncoderSettings{.width_px = settings.width_px,
                                                           .height_px = settings.height_px,
                                                           .rate_hz = settings.rate_hz,
                                                           .bit_rate_bps = settings.bit_rate_bps,
                                                           .quality = settings.quality,
                                                           .has_head = file_.has_head()});
    } catch (const Error& error) {
        fail("{} cannot be written: {}", file_.path().string(), error.what());
    }
    const AVCodecContext& context = encoder_->context();
    const AvCodecParametersPtr pictures(avcodec_parameters_alloc());
    if (!pictures || avcodec_parameters_from_context(pictures.get(), &context) < 0)
        fail("{} cannot be written: memory is short", file_.path().string());
    if (!settings.has_sound) {
        file_.open(*pictures, context.time_base, context.framerate);
        return;
    }
    sound_.emplace(settings.rate_hz, file_.sound_codec(), file_.has_head());
    const AvCodecParametersPtr sound(avcodec_parameters_alloc());
    if (!sound || avcodec_parameters_from_context(sound.get(), &sound_->encoder().context()) < 0)
        fail("{} cannot be written: memory is short", file_.path().string());
    file_.open(*pictures, context.time_base, context.framerate, sound.get());
}

void VideoWriter::add(const ColourImage& picture, std::int64_t tick, const std::string& timecode) {
    assert(tick > last_tick_);
    last_tick_ = tick;
    if (!file_.has_begun()) file_.begin(timecode);
    encoder_->add(picture, tick);
    drain();
    ++frames_;
}

void VideoWriter::hear(const SoundBlock& sound, std::int64_t tick) {
    sound_->add(sound, tick);
    drain();
}

void VideoWriter::finish() {
    if (frames_ == 0) fail("{} is not written: the film has no picture", file_.path().string());
    encoder_->end();
    if (sound_) sound_->encoder().end();
    drain();
    file_.finish();
}

void VideoWriter::drain() {
    while (AVPacket* packet = encoder_->next()) file_.write(*packet);
    if (!sound_) return;
    while (AVPacket* packet = sound_->encoder().next()) file_.write_sound(*packet);
}

}  // namespace vantage
