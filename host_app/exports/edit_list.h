#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/take/take_reader.h"
#include "host_app/ltc/smpte_code.h"
#include "host_app/replay/clip.h"

namespace vantage {

/// A film that an edit list refers to.
struct EditFilm {
    std::filesystem::path file;
    std::string reel;  ///< the tag `reel_name`, or the name of the file
    double rate_hz = 0;
    SmpteCode start;  ///< time code of the first frame
    std::int64_t frames = 0;
};
/// Reads the time code, the rate and the length of a film. Throws Error if it cannot be read or has
/// no time code.
EditFilm read_edit_film(const std::filesystem::path& file);

/// A named range of a source. Frames are numbers of time code since midnight, and go on beyond the
/// end of the day.
struct EditMark {
    std::string name;
    std::int64_t in = 0, frames = 0;
};

/// The material of an edit list: a film, or the take itself, which editors show as offline until
/// somebody links a film to it.
struct EditSource {
    std::optional<std::filesystem::path> file;  ///< absolute; empty: offline
    std::string reel;                           ///< unique in the list
    EditMark range;                             ///< the whole source
    std::vector<EditMark> marks;                ///< the clips that lie in it
};

/// A cut of the play list.
struct EditEvent {
    std::size_t source = 0;
    int clip = 0;  ///< number of the clip; 0: the whole source
    std::string name;
    std::int64_t in = 0;      ///< first frame of the source
    std::int64_t frames = 0;  ///< duration in the edit
    double speed = 1;
    std::int64_t source_frames() const;  ///< frames of the source that are shown
};

/// A play list as editors take it: cuts of sources with time code, at one rate.
struct EditList {
    std::string name;
    double rate_hz = 25;
    SmpteCount count;
    std::vector<EditSource> sources;
    std::vector<EditEvent> events;
    std::size_t offline = 0;  ///< number of events without a film
};

/// Makes the edit list of a take's clips. Its events are the play list; if that is empty all clips
/// in the order of their numbers; and without clips every source as a whole. An event refers to the
/// first film that has all of its frames. The films show the take at normal speed. `rate_hz`: of
/// the list without films; default: that of the pulses. Throws Error if films differ in rate, a
/// film's time code is not of the take's day, or the rate has no time code.
EditList make_edit_list(const TakeReader& take, const ClipBook& book,
                        const std::vector<EditFilm>& films, std::optional<double> rate_hz);

/// Counts the frames of each film from 0 instead of from its time code, for editors that ignore the
/// time code at which a film starts. Offline sources keep theirs.
void count_films_from_zero(EditList& list);

/// Writes an OpenTimelineIO timeline: a track "Play list" of the events, over one disabled track
/// per source, whose marks are markers. It begins at 01:00:00:00.
void write_otio(const EditList& list, const std::filesystem::path& file);
/// Writes the events as an EDL of the form CMX 3600, with reel names of at most 8 characters. It
/// begins at 01:00:00:00. Throws Error if there are more than 999 events.
void write_edl(const EditList& list, const std::filesystem::path& file);

}  // namespace vantage
