#include "host_app/output/media/film_file.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <fstream>
#include <mutex>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "common/av/av_input.h"
#include "common/av/av_log.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"

extern "C" {
#include <libavutil/opt.h>
}

namespace vantage {
namespace {

const char* container_of(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (extension == ".mkv") return "matroska";
    if (extension == ".mp4") return "mp4";
    fail("{} cannot be written: a film is a .mkv or .mp4 file, not '{}'", path.string(), extension);
}

/// True if the file opens and contains a frame.
bool is_readable(const std::filesystem::path& path) {
    int code = 0;
    const AvInputPtr input = open_av_input(path, code);
    const AvPacketPtr packet(av_packet_alloc());
    return input && av_read_frame(input.get(), packet.get()) >= 0;
}

/// Header of a top-level box: ISO/IEC 14496-12, 4.2.
struct BoxHead {
    std::uint64_t bytes = 0;  ///< 0: until the end of the file
    std::array<char, 4> type{};

    std::string_view name() const { return {type.data(), type.size()}; }
};

std::uint64_t big_endian(std::istream& in, int bytes) {
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) value = value << 8 | static_cast<std::uint64_t>(in.get() & 255);
    return value;
}

BoxHead read_head(std::istream& in) {
    BoxHead head;
    head.bytes = big_endian(in, 4);
    in.read(head.type.data(), head.type.size());
    constexpr std::uint64_t size_follows = 1;
    if (head.bytes == size_follows) head.bytes = big_endian(in, 8);
    return head;
}

}  // namespace

DiskSync::DiskSync(const std::filesystem::path& path)
    : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)), thread_([this](const std::stop_token& stop) {
          constexpr std::chrono::seconds period{1};
          std::mutex mutex;
          std::condition_variable_any woken;
          std::unique_lock lock(mutex);
          while (!woken.wait_for(lock, stop, period, [&] { return stop.stop_requested(); })) now();
      }) {}

void DiskSync::now() {
    if (const int reason = sync_data(fd_.get()); reason != 0) failure_ = reason;
}

void require_film_name(const std::filesystem::path& path) { (void)container_of(path); }

FilmFile::FilmFile(std::filesystem::path path)
    : path_(std::move(path)), partial_(path_.string() + fmt::format(".partial-{}", getpid())) {
    keep_av_log();
    AVFormatContext* output = nullptr;
    if (const int code =
            avformat_alloc_output_context2(&output, nullptr, container_of(path_), partial_.c_str());
        code < 0)
        fail_writing(code);
    output_.reset(output);
}

FilmFile::~FilmFile() {
    if (finished_) return;
    output_.reset();
    std::error_code ignored;
    std::filesystem::remove(partial_, ignored);
}

bool FilmFile::has_head() const { return (output_->oformat->flags & AVFMT_GLOBALHEADER) != 0; }

SoundEncoder::Codec FilmFile::sound_codec() const {
    return path_.extension() == ".mp4" ? SoundEncoder::Codec::aac : SoundEncoder::Codec::pcm;
}

AVStream& FilmFile::add_stream(const AVCodecParameters& parameters, AVRational time_base) {
    AVStream* stream = avformat_new_stream(output_.get(), nullptr);
    if (!stream || avcodec_parameters_copy(stream->codecpar, &parameters) < 0)
        fail("{} cannot be written: memory is short", path_.string());
    // Codec tags differ between containers.
    stream->codecpar->codec_tag = 0;
    stream->time_base = time_base;
    return *stream;
}

void FilmFile::open(const AVCodecParameters& pictures, AVRational time_base, AVRational rate,
                    const AVCodecParameters* sound) {
    stream_ = &add_stream(pictures, time_base);
    time_base_ = time_base;
    stream_->avg_frame_rate = rate;
    if (sound) sound_ = &add_stream(*sound, {1, sound_rate_hz});
    if (const int code =
            avio_open(&output_->pb, ("file:" + partial_.string()).c_str(), AVIO_FLAG_WRITE);
        code < 0)
        fail_writing(code);
    sync_.emplace(partial_);
    output_->flags |= AVFMT_FLAG_FLUSH_PACKETS;
    // Amount that is lost after a failure: one Matroska cluster or one MP4 fragment.
    av_opt_set_int(output_->priv_data, "cluster_time_limit", 1000, 0);
    av_opt_set_int(output_->priv_data, "frag_duration", 1'000'000, 0);
    // The header is written with the first fragment, whose time is the start of the film.
    av_opt_set(output_->priv_data, "movflags", "delay_moov+default_base_moof", 0);
}

void FilmFile::begin(const std::string& timecode) {
    if (!timecode.empty()) av_dict_set(&stream_->metadata, "timecode", timecode.c_str(), 0);
    // Editors match material by reel and time code.
    av_dict_set(&stream_->metadata, "reel_name", path_.stem().c_str(), 0);
    if (const int code = avformat_write_header(output_.get(), nullptr); code < 0)
        fail_writing(code);
    has_begun_ = true;
}

void FilmFile::write(AVPacket& packet) { write(packet, time_base_, *stream_); }

void FilmFile::write_sound(AVPacket& packet) { write(packet, {1, sound_rate_hz}, *sound_); }

void FilmFile::write(AVPacket& packet, AVRational time_base, const AVStream& stream) {
    av_packet_rescale_ts(&packet, time_base, stream.time_base);
    packet.stream_index = stream.index;
    if (const int code = av_interleaved_write_frame(output_.get(), &packet); code < 0)
        fail_writing(code);
    require_disk();
    bytes_ = static_cast<std::uint64_t>(std::max<std::int64_t>(0, avio_tell(output_->pb)));
}

void FilmFile::finish() {
    is_ended_ = true;
    if (const int code = av_write_trailer(output_.get()); code < 0) fail_writing(code);
    if (const int code = avio_closep(&output_->pb); code < 0) fail_writing(code);
    sync_->now();
    require_disk();
    std::error_code error;
    std::filesystem::rename(partial_, path_, error);
    if (error) fail("cannot write {}: {}", path_.string(), error.message());
    finished_ = true;
}

bool FilmFile::keep_what_is_written() noexcept {
    if (finished_) return true;
    // Without its index the file still opens.
    if (has_begun_ && !is_ended_) av_write_trailer(output_.get());
    is_ended_ = true;
    avio_closep(&output_->pb);
    try {
        if (path_.extension() == ".mp4") cut_to_whole_fragments(partial_);
    } catch (const Error&) {
        return false;
    }
    if (!is_readable(partial_)) return false;
    std::error_code error;
    std::filesystem::rename(partial_, path_, error);
    finished_ = !error;
    return finished_;
}

void FilmFile::require_disk() const {
    if (const int reason = sync_->failure(); reason != 0) fail_writing(AVERROR(reason));
}

void FilmFile::fail_writing(int code) const {
    fail("cannot write {}: {}", path_.string(), av_reason(code));
}

void cut_to_whole_fragments(const std::filesystem::path& path) {
    std::error_code error;
    const std::uint64_t file_bytes = std::filesystem::file_size(path, error);
    std::ifstream in(path, std::ios::binary);
    if (error || !in) fail("cannot read {}", path.string());
    // A fragment consists of a `moof` box and the `mdat` box after it.
    std::uint64_t whole = 0;
    for (std::uint64_t at = 0; at < file_bytes;) {
        in.seekg(static_cast<std::streamoff>(at));
        const BoxHead head = read_head(in);
        constexpr std::uint64_t least_box = 8;
        if (!in || head.bytes < least_box || head.bytes > file_bytes - at) break;
        at += head.bytes;
        if (head.name() != "moof") whole = at;
    }
    std::filesystem::resize_file(path, whole, error);
    if (error) fail("cannot cut {}: {}", path.string(), error.message());
}

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
