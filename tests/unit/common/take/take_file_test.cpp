#include <csignal>

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/output_path.h"
#include "common/take/take_reader.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"
#include "tests/support/source_folder.h"
#include "tests/support/thrown_sentence.h"
#include "tests/support/wire_frames.h"
#include "tests/unit/common/take/small_take.h"

namespace vantage {
namespace {

const std::vector<std::string> two_rigs{"north", "south"};
constexpr std::uint64_t first_pulse = 44'000'000'000;

class TakeFileTest : public testing::Test {
  protected:
    /// What the host decodes of what the rig sent.
    static RigFrame decoded(const PackedFrame& sent) {
        return FrameDecoder().decode(sent.header, sent.colour, sent.disparity);
    }
    static std::string run(const std::string& program, std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), program);
        const ProgramResult result = run_to_end("/usr/bin/env", arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        return result.out;
    }

    TemporaryFolder folder_;
    std::filesystem::path take_ = folder_.path() / "take.mkv";
};

TEST_F(TakeFileTest, RoundTripsEveryFrameBitForBit) {
    write_small_take(take_, two_rigs, first_pulse, first_pulse + 40, {first_pulse + 7});
    const TakeReader reader(take_);
    EXPECT_TRUE(reader.is_ended());
    EXPECT_TRUE(reader.damage().empty());
    EXPECT_EQ(reader.facts().timecode, "10:00:00:00");
    EXPECT_EQ(reader.facts().pulse_rate_hz, 25);
    ASSERT_EQ(reader.facts().rigs.size(), 2u);
    EXPECT_EQ(reader.facts().rigs, small_facts(two_rigs, first_pulse).rigs);
    ASSERT_EQ(reader.frames(0).size(), 41u);
    ASSERT_EQ(reader.frames(1).size(), 40u);
    EXPECT_DOUBLE_EQ(reader.duration_s(), 1.6);
    EXPECT_EQ(reader.frames(1)[7].pulse, first_pulse + 8);
    EXPECT_EQ(reader.frames(1)[7].gap, 1u);
    for (std::size_t rig = 0; rig < 2; ++rig) {
        FrameRestorer restorer(reader.facts().rigs[rig]);
        for (const TakeReader::Frame& frame : reader.frames(rig)) {
            const PackedFrame sent = sent_frame(two_rigs[rig], frame.pulse);
            const StoredFrame stored = reader.load(rig, frame);
            EXPECT_EQ(stored.colour, sent.colour) << "the JPEG as it came";
            EXPECT_EQ(stored.record.header.size(), sent.header.size());
            const RigFrame then = restorer.restore(stored), now = decoded(sent);
            EXPECT_TRUE(same_pixels(then.colour, now.colour));
            EXPECT_TRUE(same_pixels(then.disparity, now.disparity));
            ASSERT_EQ(then.right_jpeg != nullptr, frame.pulse % 4 == 0);
            if (then.right_jpeg) {
                EXPECT_EQ(*then.right_jpeg, *now.right_jpeg);
            }
            EXPECT_EQ(then.exposure, now.exposure);
            EXPECT_EQ(then.sync, now.sync);
            EXPECT_TRUE(then.world_from_camera.isApprox(now.world_from_camera, 0));
        }
    }
}

TEST_F(TakeFileTest, KeepsLosslessColourBitForBit) {
    constexpr int lossless = 0;
    {
        TakeWriter writer(take_, small_facts({"north"}, first_pulse, lossless));
        FrameStorer storer(writer.facts().rigs[0]);
        writer.add(0, storer.store(sent_frame("north", first_pulse, lossless)));
        writer.finish();
    }
    const TakeReader reader(take_);
    const RigFrame then =
        FrameRestorer(reader.facts().rigs[0]).restore(reader.load(0, reader.frames(0)[0]));
    EXPECT_TRUE(
        same_pixels(then.colour, decoded(sent_frame("north", first_pulse, lossless)).colour));
}

TEST_F(TakeFileTest, DecodesIntoGivenMemory) {
    for (const int quality : {0, 85}) {
        const PackedFrame sent = sent_frame("north", first_pulse, quality);
        const TakeRig rig = small_facts({"north"}, first_pulse, quality).rigs[0];
        const FrameMemory memory{ColourImage(rig.colour.size_px),
                                 DisparityImage(rig.depth.size_px)};
        const RigFrame frame = FrameRestorer(rig).restore(FrameStorer(rig).store(sent), memory);
        EXPECT_EQ(frame.colour.data, memory.colour.data) << quality;
        EXPECT_EQ(frame.disparity.data, memory.disparity.data) << quality;
        EXPECT_TRUE(same_pixels(memory.colour, decoded(sent).colour)) << quality;
        EXPECT_TRUE(same_pixels(memory.disparity, decoded(sent).disparity)) << quality;
    }
}

TEST_F(TakeFileTest, IsReadableByFfmpeg) {
    constexpr int frames = 12;
    write_small_take(take_, two_rigs, first_pulse, first_pulse + frames - 1);
    const auto streams =
        nlohmann::json::parse(run("ffprobe", {"-v", "error", "-show_streams", "-count_frames",
                                              "-of", "json", take_.string()}))["streams"];
    ASSERT_EQ(streams.size(), 2u * 2 + 2 + 1 + 1) << "pictures, frames, camera, take.json";
    EXPECT_EQ(streams[0]["codec_name"], "mjpeg");
    EXPECT_EQ(streams[0]["tags"]["title"], "north colour");
    EXPECT_EQ(streams[1]["codec_name"], "ffv1");
    EXPECT_EQ(streams[1]["pix_fmt"], "gray16le");
    EXPECT_EQ(streams[1]["tags"]["title"], "north disparity");
    for (int i = 0; i < 4; ++i) EXPECT_EQ(streams[i]["nb_read_frames"], std::to_string(frames));
    EXPECT_EQ(streams[4]["codec_type"], "subtitle");
    EXPECT_EQ(streams[7]["tags"]["filename"], "take.json");

    for (const auto& [rig, colour_track] : {std::pair("north", 0), std::pair("south", 2)}) {
        const auto depth = folder_.path() / "depth.raw", jpegs = folder_.path() / "jpegs";
        run("ffmpeg", {"-v", "error", "-y", "-i", take_.string(), "-map",
                       fmt::format("0:{}", colour_track + 1), "-f", "rawvideo", depth.string()});
        run("ffmpeg",
            {"-v", "error", "-y", "-i", take_.string(), "-map", fmt::format("0:{}", colour_track),
             "-c", "copy", "-f", "mjpeg", jpegs.string()});
        std::vector<std::byte> sent_depth, sent_jpegs;
        for (std::uint64_t pulse = first_pulse; pulse < first_pulse + frames; ++pulse) {
            const PackedFrame sent = sent_frame(rig, pulse);
            const DisparityImage disparity = decoded(sent).disparity;
            const auto pixels =
                std::as_bytes(std::span(disparity.ptr<std::uint16_t>(), disparity.total()));
            sent_depth.insert(sent_depth.end(), pixels.begin(), pixels.end());
            sent_jpegs.insert(sent_jpegs.end(), sent.colour.begin(), sent.colour.end());
        }
        EXPECT_EQ(bytes_of_file(depth), sent_depth);
        EXPECT_EQ(bytes_of_file(jpegs), sent_jpegs);
    }
    const std::string text =
        run("ffmpeg", {"-v", "error", "-i", take_.string(), "-map", "0:s:0", "-f", "srt", "-"});
    EXPECT_NE(text.find(fmt::format("\"pulse\":{}", first_pulse + 3)), std::string::npos) << text;
}

TEST_F(TakeFileTest, RoundTripsTheCameraOfEveryTick) {
    {
        TakeWriter writer(take_, small_facts({"north"}, first_pulse));
        CameraRecord camera;
        camera.tick = 5;
        camera.pulse = first_pulse;
        camera.time = writer.facts().origin + std::chrono::milliseconds(20);
        camera.world_from_camera = look_at({1, 2, 3}, {0, 1, 0});
        camera.field_of_view_rad = 0.5;
        camera.focus_m = 4;
        EXPECT_TRUE(writer.add(camera));
        camera.time = writer.facts().origin - std::chrono::seconds(1);
        EXPECT_FALSE(writer.add(camera)) << "before the take";
        writer.finish();
    }
    const TakeReader reader(take_);
    ASSERT_EQ(reader.cameras().size(), 1u);
    EXPECT_EQ(reader.cameras()[0].tick, 5u);
    EXPECT_EQ(reader.cameras()[0].pulse, first_pulse);
    EXPECT_TRUE(reader.cameras()[0].world_from_camera.isApprox(look_at({1, 2, 3}, {0, 1, 0}), 0));
}

TEST_F(TakeFileTest, ReplacesNoFile) {
    write_small_take(take_, two_rigs, first_pulse, first_pulse + 1);
    const std::vector<std::byte> before = bytes_of_file(take_);
    EXPECT_NE(thrown_sentence([&] {
                  TakeWriter(take_, small_facts(two_rigs, 1));
              }).find("never replaces a file"),
              std::string::npos);
    EXPECT_EQ(bytes_of_file(take_), before);
    EXPECT_EQ(free_path(take_).filename(), "take-2.mkv");
}

TEST_F(TakeFileTest, SurvivesAKilledProcess) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        TakeWriter writer(take_, small_facts({"north"}, first_pulse));
        FrameStorer storer(writer.facts().rigs[0]);
        for (std::uint64_t pulse = first_pulse; pulse < first_pulse + 60; ++pulse)
            writer.add(0, storer.store(sent_frame("north", pulse)));
        std::raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    const TakeReader reader(take_);
    EXPECT_FALSE(reader.is_ended());
    EXPECT_GE(reader.frames(0).size(), 60u - 13) << "half a second at most is lost";
    FrameRestorer restorer(reader.facts().rigs[0]);
    for (const TakeReader::Frame& frame : reader.frames(0))
        EXPECT_NO_THROW(restorer.restore(reader.load(0, frame)));
    run("ffmpeg", {"-v", "error", "-i", take_.string(), "-map", "0:v", "-f", "null", "-"});
}

TEST_F(TakeFileTest, OpensFromItsFirstFrameOn) {
    TakeWriter writer(take_, small_facts({"north"}, first_pulse));
    FrameStorer storer(writer.facts().rigs[0]);
    writer.add(0, storer.store(sent_frame("north", first_pulse)));
    EXPECT_EQ(TakeReader(take_).frames(0).size(), 1u);
    run("ffprobe", {"-v", "error", take_.string()});
}

TEST_F(TakeFileTest, ReadsATruncatedFile) {
    write_small_take(take_, two_rigs, first_pulse, first_pulse + 60);
    const std::vector<std::byte> whole = bytes_of_file(take_);
    const std::size_t frames = TakeReader(take_).frames(0).size();
    std::size_t most = 0;
    for (std::size_t size = 0; size < whole.size(); size += whole.size() / 150) {
        write_bytes(take_, std::span(whole).first(size));
        try {
            const TakeReader reader(take_);
            EXPECT_FALSE(reader.damage().empty() && reader.is_ended()) << size;
            EXPECT_GE(reader.frames(0).size(), most) << size;
            most = reader.frames(0).size();
            FrameRestorer restorer(reader.facts().rigs[0]);
            if (most > 0) restorer.restore(reader.load(0, reader.frames(0).back()));
        } catch (const Error& error) {
            EXPECT_EQ(most, 0u) << "only without a whole head: " << error.what();
        }
    }
    EXPECT_GE(most, frames - 13);
}

TEST_F(TakeFileTest, DetectsEveryDamagedBit) {
    write_small_take(take_, two_rigs, first_pulse, first_pulse + 30);
    const std::vector<std::byte> whole = bytes_of_file(take_);
    const TakeReader before(take_);
    // Of the pictures and records, every bit tells.
    const std::uint64_t begin = before.frames(0).front().record.at;
    const std::uint64_t end = before.frames(1).back().depth.at + before.frames(1).back().depth.size;
    // Encoded once: encoding them for every bit would take most of the test's time.
    std::map<std::pair<std::size_t, std::uint64_t>, std::vector<std::byte>> colours;
    for (std::size_t rig = 0; rig < 2; ++rig)
        for (const TakeReader::Frame& frame : before.frames(rig))
            colours[{rig, frame.pulse}] = sent_frame(two_rigs[rig], frame.pulse).colour;
    cv::RNG random(1);
    for (int i = 0; i < 300; ++i) {
        std::vector<std::byte> damaged = whole;
        const auto at =
            static_cast<std::size_t>(begin + random.uniform(0, static_cast<int>(end - begin)));
        damaged[at] ^= static_cast<std::byte>(1 << random.uniform(0, 8));
        write_bytes(take_, damaged);
        const TakeReader reader(take_);
        bool is_named = !reader.damage().empty();
        std::size_t frames = 0;
        for (std::size_t rig = 0; rig < 2; ++rig)
            for (const TakeReader::Frame& frame : reader.frames(rig)) {
                try {
                    const StoredFrame stored = reader.load(rig, frame);
                    EXPECT_EQ(stored.colour, colours.at({rig, frame.pulse}));
                    ++frames;
                } catch (const Error&) {
                    is_named = true;
                }
            }
        EXPECT_TRUE(is_named || frames == 62) << at;
    }
}

/// While it lives, files stop to grow at so many bytes, as they do on a full disk.
class SmallDisk {
  public:
    explicit SmallDisk(std::uint64_t bytes) {
        std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        rlimit small = before_;
        small.rlim_cur = bytes;
        setrlimit(RLIMIT_FSIZE, &small);
    }
    ~SmallDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

  private:
    rlimit before_{};
};

TEST_F(TakeFileTest, EndsReadableWhereTheDiskIsFull) {
    std::string sentence;
    {
        const SmallDisk disk(300'000);
        sentence = thrown_sentence([&] { write_small_take(take_, two_rigs, 100, 1000); });
    }
    EXPECT_NE(sentence.find("what was written until then can be opened"), std::string::npos)
        << sentence;
    const TakeReader reader(take_);
    EXPECT_TRUE(reader.damage().empty()) << "it ends with a whole cluster";
    EXPECT_GT(reader.frames(0).size(), 10u);
    for (const TakeReader::Frame& frame : reader.frames(0)) EXPECT_NO_THROW(reader.load(0, frame));
    run("ffmpeg", {"-v", "error", "-i", take_.string(), "-map", "0:v", "-f", "null", "-"});
}

/// In a process that sees a tmpfs in place of the folder: 0 if its take is as it should be.
int fill_small_tmpfs(const std::filesystem::path& folder) {
    constexpr int not_allowed = 77;
    if (unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return not_allowed;
    // What is mounted from now on is nobody else's.
    if (mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=400k") != 0)
        return not_allowed;
    const std::filesystem::path take = folder / "take.mkv";
    const std::string sentence =
        thrown_sentence([&] { write_small_take(take, two_rigs, 100, 10'000); });
    if (sentence.find("No space left on device; what was written until then can be opened") ==
        std::string::npos)
        return 2;
    const TakeReader reader(take);
    if (!reader.damage().empty() || reader.frames(0).size() < 10) return 3;
    for (const TakeReader::Frame& frame : reader.frames(0)) reader.load(0, frame);
    return 0;
}

TEST_F(TakeFileTest, EndsReadableOnAFullTmpfs) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) _exit(fill_small_tmpfs(folder_.path()));
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "this process may mount no tmpfs";
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_F(TakeFileTest, RefusesFilesThatAreNotTakes) {
    const auto refused = [&](const std::string& words) {
        const std::string sentence = thrown_sentence([&] { TakeReader reader(take_); });
        EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
    };
    refused("cannot read");
    write_bytes(take_, {});
    refused("not a Matroska file");
    run("ffmpeg",
        {"-v", "error", "-y", "-f", "lavfi", "-i", "testsrc=d=1:s=64x48", take_.string()});
    refused("without take.json");
}

TEST_F(TakeFileTest, RefusesFramesThatDoNotFitItsTracks) {
    FrameStorer storer(small_facts({"north"}, 1).rigs[0]);
    RigFrame larger = make_frame(3, 80, 60);
    larger.rig = "north";
    EXPECT_NE(thrown_sentence([&] {
                  storer.store(FrameEncoder(85).encode(larger));
              }).find("80x60 and disparities of 80x60, but the take's tracks have 62x46"),
              std::string::npos);
}

TEST_F(TakeFileTest, OpensAfterAnyKill) {
    cv::RNG random(static_cast<std::uint64_t>(getpid()));
    for (int i = 0; i < 25; ++i) {
        const std::filesystem::path path = folder_.path() / fmt::format("killed-{}.mkv", i);
        // A take begins with its head: before that nothing was recorded.
        int begun[2];
        ASSERT_EQ(pipe(begun), 0);
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            TakeWriter writer(path, small_facts({"north"}, first_pulse));
            if (write(begun[1], "!", 1) != 1) _exit(1);
            FrameStorer storer(writer.facts().rigs[0]);
            for (std::uint64_t pulse = first_pulse;; ++pulse)
                writer.add(0, storer.store(sent_frame("north", pulse)));
        }
        close(begun[1]);
        char told = 0;
        EXPECT_EQ(read(begun[0], &told, 1), 1);
        close(begun[0]);
        usleep(static_cast<useconds_t>(random.uniform(5'000, 60'000)));
        kill(child, SIGKILL);
        int status = 0;
        waitpid(child, &status, 0);
        const TakeReader reader(path);
        std::uint64_t next = first_pulse;
        for (const TakeReader::Frame& frame : reader.frames(0)) {
            EXPECT_EQ(frame.pulse, next++);
            EXPECT_NO_THROW(reader.load(0, frame));
        }
        for (const TakeDamage& damage : reader.damage())
            EXPECT_NE(damage.words.find("are truncated"), std::string::npos) << damage.words;
    }
}

TEST_F(TakeFileTest, RefusesInvalidNumbersInRecords) {
    const std::string text = to_text(CameraRecord{});
    const std::string open = text.substr(0, text.rfind(",\"crc32\""));
    EXPECT_NO_THROW(camera_record_from(seal_record(open)));
    const std::string facts = to_json(small_facts({"north"}, first_pulse)).dump();
    EXPECT_NO_THROW(take_facts_from(facts));
    for (const std::string number : {"1e60", "-1", "0.5", "1e18", "99999999999999999999", "true"}) {
        for (const std::string key : {"tick", "pulse", "time_tai_ns"}) {
            std::string changed = open;
            const std::size_t at = changed.find("\"" + key + "\":") + key.size() + 3;
            changed.replace(at, changed.find(',', at) - at, number);
            EXPECT_THROW(camera_record_from(seal_record(changed)), Error) << key << ' ' << number;
        }
        for (const std::string key : {"vantage_take", "origin_tai_ns"}) {
            std::string changed = facts;
            const std::size_t at = changed.find("\"" + key + "\":") + key.size() + 3;
            changed.replace(at, changed.find(',', at) - at, number);
            EXPECT_THROW(take_facts_from(changed), Error) << key << ' ' << number;
        }
    }
}

TEST_F(TakeFileTest, ReadsATakeOfVersion1) {
    const TakeReader reader(source_folder() / "tests" / "takes" / "version_1.mkv");
    EXPECT_TRUE(reader.is_ended());
    EXPECT_TRUE(reader.damage().empty());
    EXPECT_EQ(reader.facts().pulse_rate_hz, 5);
    EXPECT_EQ(reader.facts().show["view"]["synthesiser"], "mesh");
    ASSERT_EQ(reader.facts().attachments.size(), 1u);
    EXPECT_EQ(reader.facts().attachments[0].name, "stage.toml");
    EXPECT_EQ(reader.cameras().size(), 15u);
    for (const std::size_t rig : {0, 1}) {
        EXPECT_EQ(reader.facts().rigs[rig].name, rig == 0 ? "left" : "right");
        ASSERT_EQ(reader.frames(rig).size(), 15u);
        FrameRestorer restorer(reader.facts().rigs[rig]);
        for (const TakeReader::Frame& frame : reader.frames(rig)) {
            const RigFrame restored = restorer.restore(reader.load(rig, frame));
            EXPECT_EQ(restored.trigger_index, frame.pulse);
            EXPECT_EQ(restored.colour.size(), cv::Size(96, 72));
            EXPECT_GT(cv::countNonZero(restored.disparity), 96 * 72 / 2);
        }
    }
}

}  // namespace
}  // namespace vantage
