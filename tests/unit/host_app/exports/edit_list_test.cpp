#include "host_app/exports/edit_list.h"

#include <map>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/time/timecode.h"
#include "common/image/image.h"
#include "common/take/take_pulses.h"
#include "host_app/output/media/film_file.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/unit/common/take/small_take.h"

namespace vantage {
namespace {

using nlohmann::json;

/// A strict reader of OpenTimelineIO files: each object has exactly the fields that the library
/// writes for its schema, and each field the right type.
class OtioReader {
  public:
    static void check(const json& value) {
        if (value.is_array()) {
            for (const json& item : value) check(item);
            return;
        }
        if (!value.is_object() || !value.contains("OTIO_SCHEMA")) return;
        const std::string schema = value["OTIO_SCHEMA"];
        const auto fields = schemas().find(schema);
        ASSERT_NE(fields, schemas().end()) << schema;
        std::set<std::string> names{"OTIO_SCHEMA"};
        for (const auto& [name, types] : fields->second) {
            names.insert(name);
            ASSERT_TRUE(value.contains(name)) << schema << " lacks " << name;
            EXPECT_NE(types.find(type_of(value[name])), std::string::npos)
                << schema << " " << name << ": " << value[name];
        }
        for (const auto& [name, item] : value.items()) {
            EXPECT_TRUE(names.contains(name)) << schema << " has " << name;
            if (name == "media_references")
                for (const auto& [key, reference] : item.items()) check(reference);
            else
                check(item);
        }
    }

  private:
    static std::string type_of(const json& value) {
        if (!value.is_object()) return value.type_name();
        return value.contains("OTIO_SCHEMA") ? value["OTIO_SCHEMA"].get<std::string>() : "object";
    }
    using Fields = std::map<std::string, std::string>;
    static const std::map<std::string, Fields>& schemas() {
        static const Fields item{
            {"metadata", "object"}, {"name", "string"},   {"source_range", "null TimeRange.1"},
            {"effects", "array"},   {"markers", "array"}, {"enabled", "boolean"}};
        const auto with = [](Fields fields, const Fields& more) {
            fields.insert(more.begin(), more.end());
            return fields;
        };
        static const Fields reference{{"metadata", "object"},
                                      {"name", "string"},
                                      {"available_range", "null TimeRange.1"},
                                      {"available_image_bounds", "null"}};
        static const std::map<std::string, Fields> all{
            {"Timeline.1",
             {{"metadata", "object"},
              {"name", "string"},
              {"global_start_time", "null RationalTime.1"},
              {"tracks", "Stack.1"}}},
            {"Stack.1", with(item, {{"children", "array"}})},
            {"Track.1", with(item, {{"children", "array"}, {"kind", "string"}})},
            {"Clip.2", with(item, {{"media_references", "object"},
                                   {"active_media_reference_key", "string"}})},
            {"ExternalReference.1", with(reference, {{"target_url", "string"}})},
            {"MissingReference.1", reference},
            {"Marker.2",
             {{"metadata", "object"},
              {"name", "string"},
              {"color", "string"},
              {"marked_range", "TimeRange.1"}}},
            {"LinearTimeWarp.1",
             {{"metadata", "object"},
              {"name", "string"},
              {"effect_name", "string"},
              {"time_scalar", "number"}}},
            {"TimeRange.1", {{"duration", "RationalTime.1"}, {"start_time", "RationalTime.1"}}},
            {"RationalTime.1", {{"rate", "number"}, {"value", "number"}}}};
        return all;
    }
};

/// Of a take at 25 pulses per second that begins at `second` of the day of UTC.
class EditListTest : public testing::Test {
  protected:
    std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

    void take_from(std::int64_t second_of_day, std::uint64_t frames = 100) {
        const TakeFacts facts = small_facts({"north"}, 0);
        constexpr std::int64_t day_s = 86'400, days = 20'000;
        first_ = static_cast<std::uint64_t>(
            25 * (days * day_s + second_of_day + facts.tai_offset_s - zone_s(days * day_s)));
        const std::string name = "match day.mkv";
        std::filesystem::remove(path(name));
        write_small_take(path(name), {"north"}, first_, first_ + frames - 1);
        take_.emplace(path(name));
    }
    static std::int64_t zone_s(std::int64_t utc_s) {
        const time_t time = utc_s;
        tm local{};
        localtime_r(&time, &local);
        return local.tm_gmtoff;
    }
    /// A film of so many frames with this start.
    EditFilm film(const std::string& name, double rate_hz, int frames, const std::string& start) {
        VideoWriter writer(path(name), {.width_px = 16, .height_px = 16, .rate_hz = rate_hz});
        for (int i = 0; i < frames; ++i) writer.add(ColourImage(16, 16), i, start);
        writer.finish();
        return read_edit_film(path(name));
    }
    /// Clip 1 is from pulse 10 to 30 at half speed; clip 4 from 50 to 75.
    ClipBook book() const {
        ClipBook book;
        book.clips[1] = {.name = "Goal", .in = first_ + 10, .out = first_ + 30, .speed = 0.5};
        book.clips[4] = {.in = first_ + 50, .out = first_ + 75};
        book.list = {{4, {}}, {1, {}}, {1, 1.0}};
        return book;
    }
    EditList list(const std::vector<EditFilm>& films, std::optional<double> rate_hz = {}) const {
        return make_edit_list(*take_, book(), films, rate_hz);
    }
    json otio(const EditList& list) const {
        write_otio(list, path("list.otio"));
        const std::vector<std::byte> bytes = bytes_of_file(path("list.otio"));
        json read = json::parse(reinterpret_cast<const char*>(bytes.data()),
                                reinterpret_cast<const char*>(bytes.data()) + bytes.size());
        OtioReader::check(read);
        return read;
    }
    std::string edl(const EditList& list) const {
        write_edl(list, path("list.edl"));
        const std::vector<std::byte> bytes = bytes_of_file(path("list.edl"));
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }

    TemporaryFolder folder_;
    std::uint64_t first_ = 0;
    std::optional<TakeReader> take_;
};

TEST_F(EditListTest, FilmsTellTimeCodeRateLengthAndReel) {
    for (const char* name : {"wide-002.mkv", "wide-002.mp4"}) {
        const EditFilm read = film(name, 29.97, 7, "10:00:59;28");
        EXPECT_EQ(read.reel, "wide-002");
        EXPECT_EQ(read.start.text(), "10:00:59;28");
        EXPECT_DOUBLE_EQ(read.rate_hz, 30000 / 1001.0);
        EXPECT_EQ(read.frames, 7);
        const std::string shown =
            run_to_end("/usr/bin/ffprobe", {"-v", "error", "-select_streams", "v:0", "-of", "flat",
                                            "-show_streams", path(name).string()})
                .out;
        for (const char* tag : {"color_range=\"tv\"", "color_space=\"bt709\"",
                                "color_transfer=\"bt709\"", "color_primaries=\"bt709\""})
            EXPECT_NE(shown.find(tag), std::string::npos) << name << ": " << tag << shown;
    }
    EXPECT_NE(thrown_sentence([&] { film("fast.mkv", 100, 2, ""); }).find("has no time code"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] { read_edit_film(path("none.mkv")); }).find("cannot be read"),
              std::string::npos);
}

TEST_F(EditListTest, PlayListIsATimelineOverAFilm) {
    take_from(36'000);
    // The film begins 5 frames after the take.
    const EditList edit = list({film("a b%.mkv", 25, 90, "10:00:00:05")});
    ASSERT_EQ(edit.events.size(), 3u);
    EXPECT_EQ(edit.offline, 0u);
    const json timeline = otio(edit);
    EXPECT_EQ(timeline["global_start_time"]["value"], 25 * 3600);
    const json& tracks = timeline["tracks"]["children"];
    ASSERT_EQ(tracks.size(), 2u);
    const json& events = tracks[1]["children"];
    ASSERT_EQ(events.size(), 3u);
    EXPECT_EQ(events[0]["name"], "Clip 4");
    EXPECT_EQ(events[0]["source_range"]["start_time"]["value"], 25 * 36'000 + 50);
    EXPECT_EQ(events[0]["source_range"]["duration"]["value"], 25);
    EXPECT_TRUE(events[0]["effects"].empty());
    EXPECT_EQ(events[1]["name"], "Goal");
    EXPECT_EQ(events[1]["source_range"]["start_time"]["value"], 25 * 36'000 + 10);
    EXPECT_EQ(events[1]["source_range"]["duration"]["value"], 40);
    EXPECT_EQ(events[1]["effects"][0]["time_scalar"], 0.5);
    EXPECT_EQ(events[2]["source_range"]["duration"]["value"], 20);
    EXPECT_TRUE(events[2]["effects"].empty());
    const json& reference = events[1]["media_references"]["DEFAULT_MEDIA"];
    EXPECT_EQ(reference["target_url"], "file://" + folder_.path().string() + "/a%20b%25.mkv");
    EXPECT_EQ(reference["available_range"]["start_time"]["value"], 25 * 36'000 + 5);
    EXPECT_EQ(reference["available_range"]["duration"]["value"], 90);
    EXPECT_EQ(events[1]["metadata"]["cmx_3600"]["reel"], "a b%");
    // The marks of all clips are on the film itself, whose track is not shown.
    const json& whole = tracks[0]["children"][0];
    EXPECT_FALSE(whole["enabled"]);
    ASSERT_EQ(whole["markers"].size(), 2u);
    EXPECT_EQ(whole["markers"][0]["name"], "1 Goal");
    EXPECT_EQ(whole["markers"][0]["marked_range"]["start_time"]["value"], 25 * 36'000 + 10);
    EXPECT_EQ(whole["markers"][0]["marked_range"]["duration"]["value"], 20);
}

TEST_F(EditListTest, FramesOfFilmsMayCountFromZero) {
    take_from(36'000);
    EditList edit = list({film("a.mkv", 25, 90, "10:00:00:05")});
    count_films_from_zero(edit);
    const json timeline = otio(edit);
    const json& tracks = timeline["tracks"]["children"];
    const json& event = tracks[1]["children"][0];
    EXPECT_EQ(event["source_range"]["start_time"]["value"], 45);
    EXPECT_EQ(event["source_range"]["duration"]["value"], 25);
    const json& whole = tracks[0]["children"][0];
    EXPECT_EQ(whole["source_range"]["start_time"]["value"], 0);
    EXPECT_EQ(whole["markers"][0]["marked_range"]["start_time"]["value"], 5);
    const json& reference = event["media_references"]["DEFAULT_MEDIA"];
    EXPECT_EQ(reference["available_range"]["start_time"]["value"], 0);
    EXPECT_EQ(timeline["global_start_time"]["value"], 25 * 3600) << "of the edit";
    EditList offline = list({});
    const std::int64_t in = offline.events.at(0).in;
    count_films_from_zero(offline);
    EXPECT_EQ(offline.events.at(0).in, in) << "without a film, time code is all there is";
}

TEST_F(EditListTest, EdlHasReelsTimeCodeAndSpeed) {
    take_from(36'000);
    EXPECT_EQ(edl(list({film("match day.mkv.mkv", 25, 100, "10:00:00:00")})),
              "TITLE: match day\nFCM: NON-DROP FRAME\n"
              "\n001  MATCH_DA V     C        10:00:02:00 10:00:03:00 01:00:00:00 01:00:01:00\n"
              "* FROM CLIP NAME: Clip 4\n* SOURCE FILE: match day.mkv.mkv\n"
              "* LOC: 01:00:00:00 GREEN   CLIP 4\n"
              "\n002  MATCH_DA V     C        10:00:00:10 10:00:01:05 01:00:01:00 01:00:02:15\n"
              "M2   MATCH_DA       012.5                10:00:00:10\n"
              "* FROM CLIP NAME: Goal\n* SOURCE FILE: match day.mkv.mkv\n"
              "* LOC: 01:00:01:00 GREEN   CLIP 1\n"
              "\n003  MATCH_DA V     C        10:00:00:10 10:00:01:05 01:00:02:15 01:00:03:10\n"
              "* FROM CLIP NAME: Goal\n* SOURCE FILE: match day.mkv.mkv\n"
              "* LOC: 01:00:02:15 GREEN   CLIP 1\n");
}

TEST_F(EditListTest, DropFrameCodeSkipsNumbers) {
    // Clip 4 begins two frames before 10:01:00;02: the numbers ;00 and ;01 do not exist.
    take_from(36'058);
    const EditList edit = list({}, 29.97);
    const std::string text = edl(edit);
    EXPECT_NE(text.find("FCM: DROP FRAME"), std::string::npos);
    const std::string in = TimecodeClock(30000 / 1001.0)
                               .at(PulseGrid(25).time_of(first_ + 50), take_->facts().tai_offset_s);
    EXPECT_EQ(in, "10:00:59;28");
    EXPECT_EQ(edit.events[0].frames, 30);
    EXPECT_NE(text.find(" 10:00:59;28 10:01:01;00 01:00:00;00 01:00:01;00"), std::string::npos)
        << text;
    const std::size_t motion = text.find("\nM2 ");
    ASSERT_NE(motion, std::string::npos) << text;
    EXPECT_EQ(text.substr(motion + 1, text.find('\n', motion + 1) - motion).find(';'),
              std::string::npos)
        << "readers take colons only in this line";
    EXPECT_DOUBLE_EQ(otio(edit)["global_start_time"]["rate"], 30000 / 1001.0);
    EXPECT_EQ(otio(edit)["global_start_time"]["value"], 107'892);
}

TEST_F(EditListTest, MidnightIsPassed) {
    take_from(86'398);
    const EditList edit = list({film("late.mkv", 25, 100, "23:59:58:00")});
    EXPECT_NE(edl(edit).find("00:00:00:00 00:00:01:00"), std::string::npos);
    // A film that begins two seconds later, on the next day.
    const EditList after = list({film("after.mkv", 25, 100, "00:00:00:00")});
    EXPECT_EQ(after.events[0].in, 0);
    EXPECT_EQ(after.offline, 2u) << "clip 1 ends before the film begins";
}

TEST_F(EditListTest, TakesTheFirstFilmThatHasAllFrames) {
    take_from(36'000);
    const EditList edit =
        list({film("one.mkv", 25, 40, "10:00:00:00"), film("two.mkv", 25, 60, "10:00:01:15")});
    EXPECT_EQ(edit.events[0].source, 1u);
    EXPECT_EQ(edit.events[1].source, 0u);
    const std::string text = edl(edit);
    EXPECT_NE(text.find("001  TWO "), std::string::npos);
    EXPECT_NE(text.find("002  ONE "), std::string::npos);
}

TEST_F(EditListTest, ReelsDifferInTheirFirstLetters) {
    take_from(36'000);
    const EditList edit = list({film("left camera 1.mkv", 25, 40, "10:00:00:00"),
                                film("left camera 2.mkv", 25, 60, "10:00:01:15")});
    const std::string text = edl(edit);
    EXPECT_NE(text.find("  LEFT_CA2 V"), std::string::npos) << text;
    EXPECT_NE(text.find("  LEFT_CAM V"), std::string::npos) << text;
}

TEST_F(EditListTest, WithoutFilmsEventsAreOffline) {
    take_from(36'000);
    const EditList edit = list({});
    EXPECT_EQ(edit.offline, 3u);
    const json timeline = otio(edit);
    const json& event = timeline["tracks"]["children"][1]["children"][0];
    EXPECT_EQ(event["media_references"]["DEFAULT_MEDIA"]["OTIO_SCHEMA"], "MissingReference.1");
    EXPECT_EQ(event["metadata"]["cmx_3600"]["reel"], "match day");
}

TEST_F(EditListTest, WithoutAPlayListAllClipsComeAndWithoutClipsTheFilm) {
    take_from(36'000);
    ClipBook clips = book();
    clips.list.clear();
    const std::vector<EditFilm> films{film("a.mkv", 25, 90, "10:00:00:00")};
    const EditList all = make_edit_list(*take_, clips, films, {});
    ASSERT_EQ(all.events.size(), 2u);
    EXPECT_EQ(all.events[0].clip, 1);
    const EditList whole = make_edit_list(*take_, {}, films, {});
    ASSERT_EQ(whole.events.size(), 1u);
    EXPECT_EQ(whole.events[0].frames, 90);
    EXPECT_EQ(edl(whole).find("LOC"), std::string::npos);
}

TEST_F(EditListTest, RefusesRatesWithoutTimeCode) {
    take_from(36'000);
    const auto refused = [&](const std::vector<EditFilm>& films, std::optional<double> rate_hz,
                             const std::string& words) {
        const std::string sentence = thrown_sentence([&] { list(films, rate_hz); });
        EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
    };
    refused({}, 12.5, "an edit list cannot have 12.5 frames per second");
    refused({}, 100, "an edit list cannot have 100 frames per second");
    const EditFilm at_25 = film("a.mkv", 25, 2, "10:00:00:00");
    refused({at_25, film("b.mkv", 50, 2, "10:00:00:00")}, {}, "an edit list has one rate");
    refused({at_25}, 50, "--rate 50 does not apply");
    EditFilm wrong = at_25;
    wrong.start.frame = 25;
    refused({wrong}, {}, "does not exist at 25 frames per second");
}

}  // namespace
}  // namespace vantage
