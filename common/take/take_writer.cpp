#include "common/take/take_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

extern "C" {
#include <libavutil/opt.h>
}

#include "common/av/av_log.h"
#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/take/format/take_file.h"

namespace vantage {
namespace {

/// The most that is lost by a crash of the program that does not hand over, or of the computer.
constexpr std::int64_t longest_unwritten_ms = 500;
constexpr std::chrono::milliseconds longest_unsynced{500};

AVCodecID codec_id(TakePictures::Codec codec) {
    return codec == TakePictures::Codec::jpeg ? AV_CODEC_ID_MJPEG : AV_CODEC_ID_FFV1;
}

void set_setup(AVCodecParameters& parameters, std::span<const std::byte> bytes) {
    parameters.extradata =
        static_cast<std::uint8_t*>(av_mallocz(bytes.size() + AV_INPUT_BUFFER_PADDING_SIZE));
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<std::byte*>(parameters.extradata));
    parameters.extradata_size = static_cast<int>(bytes.size());
}

}  // namespace

TakeWriter::TakeWriter(std::filesystem::path path, TakeFacts facts)
    : path_(std::move(path)),
      facts_(std::move(facts)),
      duration_ms_(std::max<std::int64_t>(1, std::llround(1000 / facts_.pulse_rate_hz))),
      file_(std::make_unique<TakeFile>(path_)),
      packet_(av_packet_alloc()) {
    try {
        open();
    } catch (...) {
        // The bytes belong to TakeFile.
        if (output_) output_->pb = nullptr;
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
        throw;
    }
}

TakeWriter::~TakeWriter() {
    if (output_) output_->pb = nullptr;
}

void TakeWriter::open() {
    keep_av_log();
    AVFormatContext* context = nullptr;
    if (avformat_alloc_output_context2(&context, nullptr, "matroska", nullptr) < 0)
        fail("cannot write {}: this FFmpeg has no Matroska muxer", path_.string());
    output_.reset(context);
    output_->pb = file_->io();
    output_->flags |= AVFMT_FLAG_CUSTOM_IO | AVFMT_FLAG_BITEXACT;
    output_->avoid_negative_ts = AVFMT_AVOID_NEG_TS_DISABLED;
    av_opt_set_int(output_->priv_data, "cluster_time_limit", longest_unwritten_ms, 0);
    if (!facts_.timecode.empty())
        av_dict_set(&output_->metadata, "timecode", facts_.timecode.c_str(), 0);

    for (const TakeRig& rig : facts_.rigs) {
        Tracks& tracks = tracks_.emplace_back();
        tracks.colour = add_pictures(rig.colour, rig.name + " colour");
        tracks.depth = add_pictures(rig.depth, rig.name + " disparity");
    }
    for (std::size_t i = 0; i < facts_.rigs.size(); ++i)
        tracks_[i].record = add_text(facts_.rigs[i].name + " frames");
    camera_track_ = add_text("camera");
    if (facts_.has_sound) {
        sound_track_ = add_sound_track();
        sound_record_track_ = add_text("sound times");
        next_sound_ = sound_sample_at(facts_.origin);
    }
    const std::string told = to_json(facts_).dump(2);
    const auto bytes = std::as_bytes(std::span(told));
    attach({"take.json", "application/json", {bytes.begin(), bytes.end()}});
    for (const TakeAttachment& attachment : facts_.attachments) attach(attachment);

    if (const int code = avformat_write_header(output_.get(), nullptr); code < 0)
        fail_writing(code);
    avio_flush(output_->pb);
    if (file_->failure() != 0) fail_writing(AVERROR(file_->failure()));
    file_->mark_whole();
}

int TakeWriter::add_pictures(const TakePictures& pictures, const std::string& title) {
    if (pictures.codec == TakePictures::Codec::none) return -1;
    AVStream* stream = avformat_new_stream(output_.get(), nullptr);
    if (!stream) fail("cannot write {}: out of memory", path_.string());
    stream->codecpar->codec_type = AVMEDIA_TYPE_VIDEO;
    stream->codecpar->codec_id = codec_id(pictures.codec);
    stream->codecpar->width = pictures.size_px.width;
    stream->codecpar->height = pictures.size_px.height;
    if (!pictures.setup.empty()) set_setup(*stream->codecpar, pictures.setup);
    stream->time_base = {1, 1000};
    const AVRational rate = av_d2q(facts_.pulse_rate_hz, 1001000);
    stream->avg_frame_rate = rate;
    // Players show the first rig's colour by default.
    if (stream->index == 0) stream->disposition |= AV_DISPOSITION_DEFAULT;
    av_dict_set(&stream->metadata, "title", title.c_str(), 0);
    return stream->index;
}

int TakeWriter::add_text(const std::string& title) {
    AVStream* stream = avformat_new_stream(output_.get(), nullptr);
    if (!stream) fail("cannot write {}: out of memory", path_.string());
    stream->codecpar->codec_type = AVMEDIA_TYPE_SUBTITLE;
    stream->codecpar->codec_id = AV_CODEC_ID_SUBRIP;
    stream->time_base = {1, 1000};
    av_dict_set(&stream->metadata, "title", title.c_str(), 0);
    return stream->index;
}

int TakeWriter::add_sound_track() {
    AVStream* stream = avformat_new_stream(output_.get(), nullptr);
    if (!stream) fail("cannot write {}: out of memory", path_.string());
    AVCodecParameters& parameters = *stream->codecpar;
    parameters.codec_type = AVMEDIA_TYPE_AUDIO;
    parameters.codec_id = AV_CODEC_ID_PCM_S24LE;
    parameters.sample_rate = sound_rate_hz;
    av_channel_layout_default(&parameters.ch_layout, static_cast<int>(sound_channels));
    parameters.bits_per_coded_sample = 24;
    parameters.block_align = static_cast<int>(stored_sound_bytes);
    stream->time_base = {1, 1000};
    av_dict_set(&stream->metadata, "title", "sound", 0);
    return stream->index;
}

void TakeWriter::attach(const TakeAttachment& attachment) {
    AVStream* stream = avformat_new_stream(output_.get(), nullptr);
    if (!stream) fail("cannot write {}: out of memory", path_.string());
    stream->codecpar->codec_type = AVMEDIA_TYPE_ATTACHMENT;
    set_setup(*stream->codecpar, attachment.bytes);
    av_dict_set(&stream->metadata, "filename", attachment.name.c_str(), 0);
    av_dict_set(&stream->metadata, "mimetype", attachment.mime_type.c_str(), 0);
}

bool TakeWriter::add(std::size_t rig, StoredFrame frame) {
    Tracks& tracks = tracks_[rig];
    FrameRecord& record = frame.record;
    const std::int64_t at_ms = facts_.time_ms_of(record);
    if (at_ms < 0 || (tracks.last_ms && at_ms < *tracks.last_ms) ||
        (tracks.last_pulse && record.pulse <= *tracks.last_pulse))
        return false;
    record.gap = tracks.last_pulse ? record.pulse - *tracks.last_pulse - 1 : 0;
    record.colour_crc = frame.colour.empty() ? std::nullopt : std::optional(crc32(frame.colour));
    record.depth_crc = frame.depth.empty() ? std::nullopt : std::optional(crc32(frame.depth));
    const std::string text = to_text(record);

    flush_if_due();
    write(tracks.record, at_ms, std::as_bytes(std::span(text)));
    if (!frame.colour.empty()) write(tracks.colour, at_ms, frame.colour);
    if (!frame.depth.empty()) write(tracks.depth, at_ms, frame.depth);
    first_ms_ = frames_ == 0 ? at_ms : std::min(first_ms_, at_ms);
    last_ms_ = std::max(last_ms_, at_ms);
    ++frames_;
    gaps_ += record.gap;
    tracks.last_pulse = record.pulse;
    tracks.last_ms = at_ms;
    // FFmpeg opens no file with tracks but no frame.
    if (frames_ == 1) hand_over();
    return true;
}

bool TakeWriter::add(const CameraRecord& camera) {
    const std::int64_t at_ms = facts_.time_ms_of(camera.time);
    if (at_ms < 0 || (last_camera_ms_ && at_ms < *last_camera_ms_)) return false;
    const std::string text = to_text(camera);
    flush_if_due();
    write(camera_track_, at_ms, std::as_bytes(std::span(text)));
    last_camera_ms_ = at_ms;
    return true;
}

bool TakeWriter::add(const SoundBlock& sound) {
    return add_sound(sound.first, stored_sound(sound.samples));
}

bool TakeWriter::add_sound(std::int64_t first, std::span<const std::byte> stored) {
    const auto count = static_cast<std::int64_t>(stored.size() / stored_sound_bytes);
    const std::int64_t known = std::max<std::int64_t>(0, next_sound_ - first);
    if (known >= count) return false;
    stored = stored.subspan(static_cast<std::size_t>(known) * stored_sound_bytes);
    const SoundRecord record{first + known, static_cast<std::uint32_t>(count - known),
                             crc32(stored)};
    const std::int64_t at_ms = facts_.time_ms_of(time_of_sound(record.first));
    const std::string text = to_text(record);
    flush_if_due();
    write(sound_record_track_, at_ms, std::as_bytes(std::span(text)));
    write(sound_track_, at_ms, stored);
    next_sound_ = first + count;
    sound_samples_ += record.count;
    return true;
}

void TakeWriter::write(int track, std::int64_t at_ms, std::span<const std::byte> bytes) {
    if (!unwritten_ms_) {
        unwritten_ms_ = at_ms;
        unwritten_since_ = MonotonicClock::now();
    }
    if (const int code = av_new_packet(packet_.get(), static_cast<int>(bytes.size())); code < 0)
        fail_writing(code);
    std::memcpy(packet_->data, bytes.data(), bytes.size());
    packet_->stream_index = track;
    packet_->pts = packet_->dts = at_ms;
    packet_->duration =
        track == sound_track_
            ? static_cast<std::int64_t>(bytes.size() / stored_sound_bytes) * 1000 / sound_rate_hz
            : duration_ms_;
    packet_->flags |= AV_PKT_FLAG_KEY;
    const int code = av_write_frame(output_.get(), packet_.get());
    av_packet_unref(packet_.get());
    if (code < 0 || file_->failure() != 0) fail_writing(code);
}

void TakeWriter::flush_if_due() {
    if (unwritten_ms_ && (last_ms_ - *unwritten_ms_ >= longest_unwritten_ms ||
                          MonotonicClock::now() - unwritten_since_ >=
                              std::chrono::milliseconds(longest_unwritten_ms)))
        flush();
    sync_if_due();
}

std::optional<MonotonicTime> TakeWriter::syncing_since() const {
    return file_->is_syncing() ? std::optional(synced_at_) : std::nullopt;
}

void TakeWriter::hand_over() {
    if (unwritten_ms_) flush();
    sync_if_due();
}

void TakeWriter::sync_if_due() {
    const MonotonicTime now = MonotonicClock::now();
    if (!is_unsynced_ || now - synced_at_ < longest_unsynced || !file_->begin_sync()) return;
    is_unsynced_ = false;
    synced_at_ = now;
}

void TakeWriter::flush() {
    unwritten_ms_.reset();
    const int code = av_write_frame(output_.get(), nullptr);
    avio_flush(output_->pb);
    if (code < 0 || file_->failure() != 0) fail_writing(code);
    file_->mark_whole();
    is_unsynced_ = true;
}

void TakeWriter::finish() {
    if (is_finished_) return;
    if (unwritten_ms_) flush();
    is_finished_ = true;
    const int code = av_write_trailer(output_.get());
    avio_flush(output_->pb);
    if (code < 0 || file_->failure() != 0) fail_writing(code);
    file_->sync();
    if (file_->failure() != 0) fail_writing(AVERROR(file_->failure()));
}

void TakeWriter::fail_writing(int code) {
    is_finished_ = true;
    file_->cut_to_whole();
    fail("{} ended after {:.1f} s: {}; what was written until then can be opened", path_.string(),
         duration_s(),
         file_->failure() != 0 ? std::string(std::strerror(file_->failure())) : av_reason(code));
}

std::uint64_t TakeWriter::bytes() const { return file_->bytes(); }

double TakeWriter::duration_s() const { return static_cast<double>(last_ms_ - first_ms_) / 1000; }

void require_new_take(const std::filesystem::path& path, const char* done) {
    require_writable_output(path, {});
    if (path.extension() != ".mkv")
        fail("{} cannot be {}: a take is a Matroska file, so its name has to end in .mkv",
             path.string(), done);
    if (std::filesystem::exists(path))
        fail("{} exists, and a take never replaces a file: choose another name", path.string());
}

}  // namespace vantage
