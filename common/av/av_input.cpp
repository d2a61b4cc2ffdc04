#include "common/av/av_input.h"

#include "common/av/av_log.h"

namespace vantage {

AvInputPtr open_av_input(const std::filesystem::path& file, int& code) {
    keep_av_log();
    AVFormatContext* input = nullptr;
    code = avformat_open_input(&input, ("file:" + file.string()).c_str(), nullptr, nullptr);
    return AvInputPtr(code < 0 ? nullptr : input);
}

int find_av_stream(AVFormatContext& input, AVMediaType type, const AVCodec** decoder) {
    if (const int code = avformat_find_stream_info(&input, nullptr); code < 0) return code;
    return av_find_best_stream(&input, type, -1, -1, decoder, 0);
}

int open_av_decoder(const AVStream& stream, const AVCodec& decoder, int threads,
                    AvCodecContextPtr& opened) {
    opened.reset(avcodec_alloc_context3(&decoder));
    if (const int code = avcodec_parameters_to_context(opened.get(), stream.codecpar); code < 0)
        return code;
    opened->pkt_timebase = stream.time_base;
    opened->thread_count = threads;
    return avcodec_open2(opened.get(), &decoder, nullptr);
}

}  // namespace vantage
