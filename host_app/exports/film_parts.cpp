#include "host_app/exports/film_parts.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <span>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include "common/av/av_input.h"
#include "common/base/error.h"
#include "common/base/time/pulse_grid.h"
#include "host_app/output/media/film_file.h"

namespace vantage {
namespace {

/// Reads the encoded pictures of a part in decoding order.
class PartReader {
  public:
    explicit PartReader(const std::filesystem::path& file) : file_(file) {
        int code = 0;
        input_ = open_av_input(file, code);
        if (!input_) refuse(code);
        code = find_av_stream(*input_, AVMEDIA_TYPE_VIDEO);
        if (code < 0) refuse(code);
        stream_ = input_->streams[code];
    }

    const AVCodecParameters& pictures() const { return *stream_->codecpar; }

    /// Packets with the number of their picture in the part as time.
    std::vector<AvPacketPtr> packets(AVRational tick) {
        std::vector<AvPacketPtr> packets;
        for (;;) {
            AvPacketPtr packet(av_packet_alloc());
            const int code = av_read_frame(input_.get(), packet.get());
            if (code == AVERROR_EOF) break;
            if (code < 0) refuse(code);
            if (packet->stream_index != stream_->index) continue;
            packet->pts =
                av_rescale_q_rnd(packet->pts, stream_->time_base, tick, AV_ROUND_NEAR_INF);
            packets.push_back(std::move(packet));
        }
        if (packets.empty()) refuse(AVERROR_INVALIDDATA);
        const auto earlier = [](const AvPacketPtr& a, const AvPacketPtr& b) {
            return a->pts < b->pts;
        };
        const std::int64_t first =
            (*std::min_element(packets.begin(), packets.end(), earlier))->pts;
        std::vector<bool> is_there(packets.size());
        for (const AvPacketPtr& packet : packets) {
            packet->pts -= first;
            const auto number = static_cast<std::size_t>(packet->pts);
            if (number >= packets.size() || is_there[number]) refuse(AVERROR_INVALIDDATA);
            is_there[number] = true;
        }
        return packets;
    }

  private:
    [[noreturn]] void refuse(int code) const {
        fail("{} cannot be resumed ({}): delete it", file_.string(), av_reason(code));
    }

    std::filesystem::path file_;
    AvInputPtr input_;
    const AVStream* stream_ = nullptr;
};

std::span<const std::uint8_t> head_of(const AVCodecParameters& pictures) {
    return {pictures.extradata, static_cast<std::size_t>(pictures.extradata_size)};
}

AVRational tick_of(double rate_hz) {
    const PulseGrid::Fraction rate = PulseGrid(rate_hz).rate();
    AVRational tick{};
    av_reduce(&tick.num, &tick.den, rate.seconds, rate.pulses, INT32_MAX);
    return tick;
}

/// Deletes the temporary files of an export that was killed.
void remove_unfinished(const std::filesystem::path& folder) {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
        if (entry.path().filename().string().find(".partial-") != std::string::npos)
            std::filesystem::remove(entry.path(), ignored);
}

}  // namespace

std::filesystem::path FilmParts::folder_of(const std::filesystem::path& film) {
    return film.string() + ".parts";
}

FilmParts::FilmParts(std::filesystem::path folder, double rate_hz)
    : folder_(std::move(folder)),
      rate_hz_(rate_hz),
      tick_(tick_of(rate_hz)),
      lock_(::open((folder_ / "export.json").c_str(), O_RDONLY | O_CLOEXEC)) {
    if (!lock_) fail("cannot read {}: {}", folder_.string(), std::strerror(errno));
    if (::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0)
        fail("another export is writing to {}: wait until it has ended", folder_.string());
    remove_unfinished(folder_);
    while (std::filesystem::exists(next())) take_in(next());
}

std::filesystem::path FilmParts::next() const {
    // MP4 stores times exactly.
    return folder_ / fmt::format("{:08}.mp4", pictures_);
}

void FilmParts::take_in(std::filesystem::path file) {
    Part part{std::move(file), pictures_, 0, 0};
    const std::vector<AvPacketPtr> packets = PartReader(part.file).packets(tick_);
    part.pictures = packets.size();
    for (std::size_t i = 0; i < packets.size(); ++i)
        part.delay = std::max(part.delay, static_cast<std::int64_t>(i) - packets[i]->pts);
    pictures_ += part.pictures;
    parts_.push_back(std::move(part));
}

void FilmParts::add(std::uint64_t pictures) {
    take_in(next());
    if (parts_.back().pictures != pictures)
        fail("{} has {} pictures instead of {}", parts_.back().file.string(),
             parts_.back().pictures, pictures);
}

void FilmParts::join(const std::filesystem::path& film, const std::string& timecode,
                     const std::vector<std::shared_ptr<const SoundBlock>>& sound) const {
    std::int64_t delay = 0;
    for (const Part& part : parts_) delay = std::max(delay, part.delay);
    FilmFile file(film);
    const PartReader head(parts_.front().file);
    std::optional<SoundTrack> track;
    AvCodecParametersPtr track_head;
    if (!sound.empty()) {
        track.emplace(rate_hz_, file.sound_codec(), file.has_head());
        track_head.reset(avcodec_parameters_alloc());
        avcodec_parameters_from_context(track_head.get(), &track->encoder().context());
    }
    file.open(head.pictures(), tick_, av_inv_q(tick_), track_head.get());
    file.begin(timecode);
    const auto write_sound = [&] {
        while (AVPacket* packet = track->encoder().next()) file.write_sound(*packet);
    };
    for (const Part& part : parts_) {
        PartReader reader(part.file);
        if (!std::ranges::equal(head_of(head.pictures()), head_of(reader.pictures())))
            fail("{} was made by another encoder than the parts before it: delete {}",
                 part.file.string(), folder_.string());
        auto number = static_cast<std::int64_t>(part.first);
        for (const AvPacketPtr& packet : reader.packets(tick_)) {
            packet->pts += static_cast<std::int64_t>(part.first);
            const auto tick = static_cast<std::size_t>(number);
            packet->dts = number++ - delay;
            packet->duration = 1;
            file.write(*packet);
            if (!track || tick >= sound.size()) continue;
            track->add(*sound[tick], static_cast<std::int64_t>(tick));
            write_sound();
        }
    }
    if (track) {
        track->encoder().end();
        write_sound();
    }
    file.finish();
}

}  // namespace vantage
