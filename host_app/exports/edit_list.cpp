#include "host_app/exports/edit_list.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "common/av/av_input.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/time/pulse_grid.h"
#include "common/base/time/timecode.h"
#include "common/take/take_pulses.h"

namespace vantage {
namespace {

constexpr int most_numbers = 60;

std::string tag_of(const AVDictionary* tags, const char* key) {
    const AVDictionaryEntry* tag = av_dict_get(tags, key, nullptr, 0);
    return tag ? tag->value : "";
}

/// The tag of the pictures, or of another stream: MP4 has a track for time code.
std::string tag_of(const AVFormatContext& film, const AVStream& pictures, const char* key) {
    std::string text = tag_of(pictures.metadata, key);
    for (unsigned i = 0; text.empty() && i < film.nb_streams; ++i)
        text = tag_of(film.streams[i]->metadata, key);
    return text.empty() ? tag_of(film.metadata, key) : text;
}

std::int64_t count_pictures(AVFormatContext& film, int stream) {
    std::int64_t count = 0;
    const AvPacketPtr packet(av_packet_alloc());
    for (; av_read_frame(&film, packet.get()) >= 0; av_packet_unref(packet.get()))
        if (packet->stream_index == stream) ++count;
    return count;
}

/// The way of counting frames in time code at a rate of n or n * 1000 / 1001 per second.
SmpteCount count_at(double rate_hz) {
    const auto numbers = static_cast<int>(std::ceil(rate_hz - 1e-9));
    const double nominal_share = numbers / rate_hz;
    constexpr double tolerance = 1e-6;
    const bool is_whole = std::abs(nominal_share - 1) < tolerance;
    const bool is_ntsc = std::abs(nominal_share - 1.001) < tolerance;
    if (numbers > most_numbers || !(is_whole || is_ntsc))
        fail(
            "an edit list cannot have {:.6g} frames per second: time code needs a whole rate of at "
            "most 60, or one such as 29.97; give --rate, and render the films at that rate",
            rate_hz);
    return {numbers, is_ntsc && numbers % 30 == 0};
}

/// Places pulses of a take in time code, counted in frames since the midnight before the take.
class EditClock {
  public:
    EditClock(const TakeReader& take, double rate_hz)
        : pulses_(take.facts().pulse_rate_hz),
          frames_(rate_hz),
          codes_(rate_hz),
          count_(count_at(rate_hz)),
          tai_offset_s_(take.facts().tai_offset_s),
          first_(frame_of_pulse(pulse_span_of(take).first)),
          first_number_(number_of(codes_.of_pulse(first_, tai_offset_s_), take.path())) {}

    const SmpteCount& count() const { return count_; }
    /// The frames from a pulse to another.
    std::int64_t frames_between(std::uint64_t in, std::uint64_t out) const {
        return static_cast<std::int64_t>(frame_of_pulse(out) - frame_of_pulse(in));
    }
    /// The number of a pulse where the take's code counts without a break from its start.
    std::int64_t number_of_pulse(std::uint64_t pulse) const {
        return first_number_ + static_cast<std::int64_t>(frame_of_pulse(pulse) - first_);
    }
    /// How many frames the film begins after the take, by their time codes.
    std::int64_t delay_of(const EditFilm& film) const {
        const TimeLabel label{film.start.hours, film.start.minutes, film.start.seconds,
                              film.start.frame, std::nullopt};
        // A film may have begun before the take, and after the midnight before or after it.
        constexpr double half_day_s = 43'200;
        const auto half_day = static_cast<std::uint64_t>(half_day_s * frames_.rate_hz());
        const std::optional<std::uint64_t> start =
            codes_.find(label, first_ - half_day, first_ + half_day, tai_offset_s_);
        if (!start)
            fail("{} starts at {}, and no frame of that day has this time code at {:.6g} fps",
                 film.file.string(), film.start.text(), frames_.rate_hz());
        return static_cast<std::int64_t>(*start - first_);
    }
    std::int64_t number_of(const std::string& text, const std::filesystem::path& file) const {
        const std::optional<SmpteCode> code = SmpteCode::parse(text);
        const std::optional<std::int64_t> number = code ? count_.frame_of(*code) : std::nullopt;
        if (!number)
            fail("{} has the time code '{}', which does not exist at {:.6g} frames per second",
                 file.string(), text, frames_.rate_hz());
        return *number;
    }

  private:
    std::uint64_t frame_of_pulse(std::uint64_t pulse) const {
        return frames_.index_at_or_before(pulses_.time_of(pulse));
    }

    PulseGrid pulses_, frames_;
    TimecodeClock codes_;
    SmpteCount count_;
    int tai_offset_s_;
    std::uint64_t first_;
    std::int64_t first_number_;
};

std::string name_of(int number, const Clip& clip) {
    return clip.name.empty() ? fmt::format("Clip {}", number) : clip.name;
}

std::string unique_reel(std::string reel, std::set<std::string>& taken) {
    const std::string wanted = reel;
    for (int n = 2; !taken.insert(reel).second; ++n) reel = fmt::format("{}-{}", wanted, n);
    return reel;
}

/// Builds an edit list.
class EditListMaker {
  public:
    EditListMaker(const TakeReader& take, const std::vector<EditFilm>& films, double rate_hz)
        : take_(take), clock_(take, rate_hz), span_(pulse_span_of(take)) {
        list_.name = take.path().stem().string();
        list_.rate_hz = rate_hz;
        list_.count = clock_.count();
        for (const EditFilm& film : films) add(film);
        if (films.empty()) (void)offline_source();
    }

    EditList make(const ClipBook& book) {
        for (const PlayEntry& entry : book.list)
            add(entry.clip, book.clips.at(entry.clip), entry.speed);
        if (book.list.empty())
            for (const auto& [number, clip] : book.clips) add(number, clip, std::nullopt);
        if (list_.events.empty()) {
            for (std::size_t i = 0; i < list_.sources.size(); ++i) {
                const EditSource& source = list_.sources[i];
                list_.events.push_back({i, 0, source.reel, source.range.in, source.range.frames});
            }
        }
        for (std::size_t i = 0; i < list_.sources.size(); ++i)
            for (const auto& [number, clip] : book.clips) mark(i, number, clip);
        for (const EditEvent& event : list_.events)
            if (!list_.sources[event.source].file) ++list_.offline;
        return list_;
    }

  private:
    void add(const EditFilm& film) {
        const std::int64_t start = clock_.number_of(film.start.text(), film.file);
        list_.sources.push_back({std::filesystem::absolute(film.file),
                                 unique_reel(film.reel, reels_),
                                 {film.file.stem().string(), start, film.frames},
                                 {}});
        // Where the film's own count places the first pulse of the take.
        first_numbers_.push_back(start - clock_.delay_of(film));
    }
    std::size_t offline_source() {
        if (!offline_) {
            offline_ = list_.sources.size();
            const std::int64_t frames =
                std::max<std::int64_t>(1, clock_.frames_between(span_.first, span_.last + 1));
            first_numbers_.push_back(clock_.number_of_pulse(span_.first));
            list_.sources.push_back({std::nullopt,
                                     unique_reel(list_.name, reels_),
                                     {list_.name, first_numbers_.back(), frames},
                                     {}});
        }
        return *offline_;
    }

    EditMark range_in(std::size_t source, int number, const Clip& clip) const {
        const std::int64_t in = first_numbers_[source] + clock_.number_of_pulse(clip.in) -
                                clock_.number_of_pulse(span_.first);
        return {name_of(number, clip), in,
                std::max<std::int64_t>(1, clock_.frames_between(clip.in, clip.out))};
    }
    /// The frames of the range that the source has.
    std::int64_t shared_frames(std::size_t source, const EditMark& range) const {
        const EditMark& whole = list_.sources[source].range;
        return std::min(range.in + range.frames, whole.in + whole.frames) -
               std::max(range.in, whole.in);
    }

    std::size_t source_of(int number, const Clip& clip) {
        std::optional<std::size_t> partial;
        for (std::size_t i = 0; i < list_.sources.size(); ++i) {
            if (!list_.sources[i].file) continue;
            const EditMark range = range_in(i, number, clip);
            const std::int64_t shared = shared_frames(i, range);
            if (shared == range.frames) return i;
            if (shared > 0 && !partial) partial = i;
        }
        if (partial)
            log_warning("clip {} is only partly in {}", number,
                        list_.sources[*partial].file->string());
        return partial ? *partial : offline_source();
    }

    void add(int number, const Clip& clip, std::optional<double> speed) {
        const std::size_t source = source_of(number, clip);
        const EditMark range = range_in(source, number, clip);
        EditEvent event{source,   number,       range.name,
                        range.in, range.frames, speed.value_or(clip.speed)};
        event.frames = std::max<std::int64_t>(
            1, std::llround(static_cast<double>(range.frames) / event.speed));
        list_.events.push_back(std::move(event));
    }
    void mark(std::size_t source, int number, const Clip& clip) {
        EditMark range = range_in(source, number, clip);
        if (shared_frames(source, range) <= 0) return;
        range.name = clip.name.empty() ? range.name : fmt::format("{} {}", number, clip.name);
        list_.sources[source].marks.push_back(std::move(range));
    }

    const TakeReader& take_;
    EditClock clock_;
    PulseSpan span_;
    EditList list_;
    std::set<std::string> reels_;
    std::vector<std::int64_t> first_numbers_;  ///< of the take's first pulse, for each source
    std::optional<std::size_t> offline_;
};

}  // namespace

std::int64_t EditEvent::source_frames() const {
    return std::max<std::int64_t>(1, std::llround(static_cast<double>(frames) * speed));
}

void count_films_from_zero(EditList& list) {
    for (std::size_t i = 0; i < list.sources.size(); ++i) {
        EditSource& source = list.sources[i];
        if (!source.file) continue;
        const std::int64_t start = std::exchange(source.range.in, 0);
        for (EditMark& mark : source.marks) mark.in -= start;
        for (EditEvent& event : list.events)
            if (event.source == i) event.in -= start;
    }
}

EditFilm read_edit_film(const std::filesystem::path& file) {
    int code = 0;
    const AvInputPtr input = open_av_input(file, code);
    if (input) code = find_av_stream(*input, AVMEDIA_TYPE_VIDEO);
    if (code < 0) fail("{} cannot be read as a film: {}", file.string(), av_reason(code));
    const AVStream& pictures = *input->streams[code];
    const double measured_hz =
        av_q2d(pictures.avg_frame_rate.num > 0 ? pictures.avg_frame_rate : pictures.r_frame_rate);
    constexpr double least_hz = 0.1, most_hz = 1000;
    if (!(measured_hz >= least_hz && measured_hz <= most_hz))
        fail("{} has no frame rate, and an edit list needs one", file.string());
    const double rate_hz = PulseGrid(measured_hz).rate_hz();
    const std::string text = tag_of(*input, pictures, "timecode");
    const std::optional<SmpteCode> start = SmpteCode::parse(text);
    if (!start)
        fail(
            "{} has no time code: record it with --record, or export it with --as film, at a rate "
            "of at most 60 fps",
            file.string());
    EditFilm film{file, tag_of(*input, pictures, "reel_name"), rate_hz, *start, 0};
    if (film.reel.empty()) film.reel = file.stem().string();
    film.frames = count_pictures(*input, code);
    if (film.frames == 0) fail("{} has no frames", file.string());
    return film;
}

EditList make_edit_list(const TakeReader& take, const ClipBook& book,
                        const std::vector<EditFilm>& films, std::optional<double> rate_hz) {
    const double list_hz = PulseGrid(films.empty() ? rate_hz.value_or(take.facts().pulse_rate_hz)
                                                   : films.front().rate_hz)
                               .rate_hz();
    for (const EditFilm& film : films)
        if (film.rate_hz != list_hz)
            fail("{} has {:.6g} fps and {} {:.6g} fps: an edit list has one rate",
                 films.front().file.string(), list_hz, film.file.string(), film.rate_hz);
    if (rate_hz && PulseGrid(*rate_hz).rate_hz() != list_hz)
        fail("--rate {:.6g} does not apply: {} has {:.6g} fps, which is the rate of the edit list",
             *rate_hz, films.front().file.string(), list_hz);
    return EditListMaker(take, films, list_hz).make(book);
}

}  // namespace vantage
