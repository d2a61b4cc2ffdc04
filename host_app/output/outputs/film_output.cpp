#include <charconv>
#include <cmath>
#include <optional>

#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "host_app/output/media/film_file.h"
#include "host_app/output/output_target.h"

namespace vantage {
namespace {

/// Largest length and size of one part of a film; without them the film is one file.
struct FilmParts {
    std::optional<double> seconds;
    std::optional<std::uint64_t> bytes;
    bool is_one() const { return !seconds && !bytes; }
};

FilmParts parts_of(const OutputUrl& url) {
    FilmParts parts;
    const std::optional<std::string> text = url.option("segment");
    if (!text) return parts;
    double value = 0;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
    const std::string unit(end, text->data() + text->size());
    constexpr double least_s = 1, most_s = 86400, least_mb = 1, mb_a_gb = 1000, most_mb = 1e7;
    if (error == std::errc() && unit == "s" && value >= least_s && value <= most_s) {
        parts.seconds = value;
        return parts;
    }
    const double mb = unit == "GB" ? mb_a_gb * value : value;
    if (error != std::errc() || !(unit == "MB" || unit == "GB") ||
        !(mb >= least_mb && mb <= most_mb))
        fail(
            "the output {}: a segment is so long or so large, at least a second or a megabyte: "
            "segment=60s, segment=500MB, segment=4GB",
            url.shown);
    constexpr double bytes_a_mb = 1e6;
    parts.bytes = static_cast<std::uint64_t>(bytes_a_mb * mb);
    return parts;
}

/// Path of a part: "film-001.mkv" of "film.mkv".
std::filesystem::path part_path(const std::filesystem::path& path, int number) {
    return path.parent_path() /
           fmt::format("{}-{:03}{}", path.stem().string(), number, path.extension().string());
}

/// State that all openings of one film share.
struct Film {
    std::filesystem::path path;
    VideoSettings settings;
    FilmParts parts;
    bool overwrites = false;
    bool has_begun = false;  ///< started before, so that earlier files must not be replaced
    int last_part = 0;

    std::filesystem::path next_path() {
        const bool may_replace = overwrites && !has_begun;
        has_begun = true;
        if (parts.is_one()) return may_replace ? path : free_path(path);
        std::filesystem::path next = part_path(path, ++last_part);
        while (!overwrites && std::filesystem::exists(next)) next = part_path(path, ++last_part);
        return next;
    }
};

class FilmTarget final : public OutputTarget {
  public:
    explicit FilmTarget(std::shared_ptr<Film> film) : film_(std::move(film)) { begin(0); }

    void write(const ColourImage& picture, std::int64_t tick,
               const std::string& timecode) override {
        if (is_full(tick)) {
            writer_->finish();
            written_ += writer_->bytes();
            begin(tick);
        }
        writer_->add(picture, tick - first_tick_, timecode);
    }
    void hear(const SoundBlock& sound, std::int64_t tick) override {
        // Sound of a part that is already complete is skipped.
        if (writer_->frames() > 0 && tick >= first_tick_) writer_->hear(sound, tick - first_tick_);
    }
    void finish() override { writer_->finish(); }
    std::string salvage() override {
        if (writer_->frames() == 0) return "";
        return writer_->keep_what_is_written() ? "; what was written until then is kept"
                                               : "; nothing of it can be read";
    }
    std::uint64_t bytes() const override { return written_ + writer_->bytes(); }

  private:
    void begin(std::int64_t tick) {
        first_tick_ = tick;
        writer_.emplace(film_->next_path(), film_->settings);
    }
    bool is_full(std::int64_t tick) const {
        const FilmParts& parts = film_->parts;
        if (writer_->frames() == 0) return false;
        if (parts.seconds)
            return tick - first_tick_ >= std::llround(*parts.seconds * film_->settings.rate_hz);
        return parts.bytes && writer_->bytes() >= *parts.bytes;
    }

    std::shared_ptr<Film> film_;
    std::optional<VideoWriter> writer_;
    std::int64_t first_tick_ = 0;
    std::uint64_t written_ = 0;  ///< bytes of earlier parts
};

OutputPlan plan(const OutputUrl& url, const OutputFormat& format) {
    url.require_options_of({"segment", "bitrate"});
    auto film = std::make_shared<Film>();
    film->path = url.place;
    film->parts = parts_of(url);
    film->overwrites = format.overwrites;
    film->settings = {.width_px = format.width_px,
                      .height_px = format.height_px,
                      .rate_hz = format.rate_hz,
                      .bit_rate_bps = url.bit_rate_bps(),
                      .encoder = format.encoder,
                      .has_sound = format.has_sound};
    require_film_name(film->path);
    require_writable_output(film->path, {});
    const std::filesystem::path first =
        film->parts.is_one() ? film->path : part_path(film->path, 1);
    if (!format.overwrites && std::filesystem::exists(first))
        fail(
            "{} is there already, and a film is not replaced without being asked: take another "
            "name, or --overwrite",
            first.string());
    if (format.width_px % 2 != 0 || format.height_px % 2 != 0)
        fail("a film of {}x{} cannot be recorded: its sides have to be even", format.width_px,
             format.height_px);
    return {.name = "film " + url.shown,
            .film = url.place,
            .takes_sound = format.has_sound,
            .open = [film](const OutputPatience&) { return std::make_unique<FilmTarget>(film); }};
}

}  // namespace

OutputEntry film_output_entry() {
    return {"file", "a file (FILM.mkv or .mp4; ?segment=60s or 500MB, bitrate=6M)", plan};
}

}  // namespace vantage
