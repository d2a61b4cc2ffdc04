#include "tests/unit/host_app/output/probed_film.h"

#include "common/av/av_handles.h"
#include "common/base/error.h"

namespace vantage {
namespace {

void require(int code, const std::filesystem::path& path) {
    if (code < 0) fail("{} cannot be read: {}", path.string(), av_reason(code));
}

struct InputDeleter {
    void operator()(AVFormatContext* context) const { avformat_close_input(&context); }
};

}  // namespace

ProbedFilm probe_film(const std::filesystem::path& path) {
    AVFormatContext* opened = nullptr;
    require(avformat_open_input(&opened, path.c_str(), nullptr, nullptr), path);
    const std::unique_ptr<AVFormatContext, InputDeleter> input(opened);
    require(avformat_find_stream_info(input.get(), nullptr), path);
    const AVStream* stream = input->streams[0];
    const AVCodec* codec = avcodec_find_decoder(stream->codecpar->codec_id);
    const AvCodecContextPtr decoder(avcodec_alloc_context3(codec));
    require(avcodec_parameters_to_context(decoder.get(), stream->codecpar), path);
    require(avcodec_open2(decoder.get(), codec, nullptr), path);

    ProbedFilm film;
    film.codec = avcodec_get_name(stream->codecpar->codec_id);
    film.container = input->iformat->name;
    if (const AVDictionaryEntry* tag = av_dict_get(stream->metadata, "timecode", nullptr, 0))
        film.timecode = tag->value;
    film.rate = stream->r_frame_rate;
    film.width_px = stream->codecpar->width;
    film.height_px = stream->codecpar->height;
    film.duration_s = static_cast<double>(input->duration) / AV_TIME_BASE;
    const AvPacketPtr packet(av_packet_alloc());
    const AvFramePtr frame(av_frame_alloc());
    const auto take_pictures = [&] {
        while (avcodec_receive_frame(decoder.get(), frame.get()) == 0) {
            film.times_s.push_back(static_cast<double>(frame->pts) * av_q2d(stream->time_base));
            film.middle_lumas.push_back(
                frame->data[0][frame->height / 2 * frame->linesize[0] + frame->width / 2]);
        }
    };
    while (av_read_frame(input.get(), packet.get()) == 0) {
        // Beside the pictures there may be a track of time code.
        if (packet->stream_index == stream->index)
            require(avcodec_send_packet(decoder.get(), packet.get()), path);
        av_packet_unref(packet.get());
        take_pictures();
    }
    require(avcodec_send_packet(decoder.get(), nullptr), path);
    take_pictures();
    return film;
}

}  // namespace vantage
