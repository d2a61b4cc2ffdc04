#include <cmath>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "common/image/image_file.h"
#include "common/image/pfm.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

constexpr int shift_px = 7;

/// Runs the program on a small pair of noise, the left picture 7 px to the right of the right one.
class MatchCommandTest : public testing::Test {
  protected:
    MatchCommandTest() {
        ColourImage right(47, 61);
        cv::RNG(1).fill(right, cv::RNG::UNIFORM, 0, 256);
        cv::GaussianBlur(right, right, {3, 3}, 0.8);
        ColourImage left(right.size());
        for (int y = 0; y < left.rows; ++y)
            for (int x = 0; x < left.cols; ++x) left(y, x) = right(y, std::max(x - shift_px, 0));
        write_colour_image(left_, left);
        write_colour_image(right_, right);
        std::ofstream(output_) << "what stood here before";
    }

    static ProgramResult run(const std::vector<std::string>& arguments) {
        return run_to_end(VANTAGE_RIG, arguments);
    }
    ProgramResult match(std::vector<std::string> more) {
        more.insert(more.begin(), {"match", left_, right_, "-o", output_});
        return run(more);
    }
    std::string path(const char* name) const { return folder_.path() / name; }

    /// One line on stderr that names `words`, a status that is not 0, nothing on stdout, and the
    /// old output as it was.
    void expect_refusal(const ProgramResult& result, const std::vector<std::string>& words) {
        EXPECT_NE(result.status, 0);
        EXPECT_LT(result.status, 126) << "the program crashed";
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        for (const std::string& word : words)
            EXPECT_NE(result.err.find(word), std::string::npos)
                << "'" << word << "' is not in: " << result.err;
        std::ifstream in(output_);
        const std::string text{std::istreambuf_iterator<char>(in),
                               std::istreambuf_iterator<char>()};
        EXPECT_TRUE(text == "what stood here before") << "the old output was touched";
    }

    TemporaryFolder folder_;
    std::string left_ = path("left.png"), right_ = path("right.png"), output_ = path("out.pfm");
};

TEST_F(MatchCommandTest, WritesDisparitiesAndAColourMapAndSaysSoInJson) {
    const std::string map = path("map.png");
    const ProgramResult result =
        match({"--disparities", "16", "--matcher", "gradient", "--colormap", map, "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("width"), 61);
    EXPECT_EQ(json.at("height"), 47);
    EXPECT_EQ(json.at("disparities"), 16);
    EXPECT_EQ(json.at("matcher"), "gradient");
    EXPECT_EQ(json.at("preset"), "balanced");
    EXPECT_GT(json.at("gpu_ms"), 0);
    EXPECT_NE(json.at("renderer"), "");
    EXPECT_EQ(json.at("density"), 1.0);
    const cv::Mat1f px = read_pfm(output_);
    ASSERT_EQ(px.size(), cv::Size(61, 47));
    EXPECT_EQ(px(23, 40), shift_px);
    EXPECT_EQ(read_colour_image(map).size(), px.size());
}

TEST_F(MatchCommandTest, MatchesWithEveryPreset) {
    for (const char* preset : {"fast", "balanced", "quality"}) {
        const ProgramResult result = match({"--disparities", "16", "--preset", preset});
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_NEAR(read_pfm(output_)(23, 40), shift_px, 0.5) << preset;
    }
}

TEST_F(MatchCommandTest, StatesTheScaleOfA16BitPng) {
    const std::string png = path("out.png");
    const ProgramResult result = run({"match", left_, right_, "--disparities", "16", "--matcher",
                                      "gradient", "-o", png, "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const double px_per_code = nlohmann::json::parse(result.out).at("px_per_code");
    EXPECT_EQ(read_code_image(png)(23, 40) * px_per_code, shift_px);
}

TEST_F(MatchCommandTest, LeavesUnknownAsInfinityWithoutFilling) {
    const ProgramResult result =
        match({"--disparities", "16", "--matcher", "gradient", "--no-fill", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const cv::Mat1f px = read_pfm(output_);
    int unknown = 0;
    for (const float d : px) unknown += std::isinf(d);
    EXPECT_GT(unknown, 0);
    const double density = nlohmann::json::parse(result.out).at("density");
    EXPECT_DOUBLE_EQ(density, 1.0 - unknown / static_cast<double>(px.total()));
}

TEST_F(MatchCommandTest, WritesHowSureItIsAndIsNotOfWhatItFilled) {
    const std::string confidence = path("confidence.png");
    const ProgramResult dense =
        match({"--preset", "quality", "--disparities", "16", "--confidence", confidence, "--json"});
    ASSERT_EQ(dense.status, 0) << dense.err;
    const auto json = nlohmann::json::parse(dense.out);
    EXPECT_EQ(json.at("confidence"), confidence);
    EXPECT_EQ(json.at("density"), 1.0);
    const cv::Mat1w sure = read_code_image(confidence);
    ASSERT_EQ(sure.size(), cv::Size(61, 47));
    EXPECT_GT(sure(23, 40), 64);
    EXPECT_NEAR(json.at("mean_confidence"), cv::mean(sure)[0] / 255, 1e-9);

    ASSERT_EQ(match({"--preset", "quality", "--disparities", "16", "--no-fill"}).status, 0);
    const cv::Mat1f px = read_pfm(output_);
    int unknown = 0;
    for (int y = 0; y < px.rows; ++y)
        for (int x = 0; x < px.cols; ++x) {
            if (!std::isinf(px(y, x))) continue;
            ++unknown;
            ASSERT_EQ(sure(y, x), 0) << x << ", " << y;
        }
    EXPECT_GT(unknown, 0);
}

TEST_F(MatchCommandTest, RefusesConfidenceThatCannotBeHad) {
    const std::vector<std::string> request = {"--disparities", "16", "--confidence"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), request.begin(), request.end());
        return match(more);
    };
    expect_refusal(with({path("sure.jpg")}), {"sure.jpg", ".png"});
    expect_refusal(with({path("missing/sure.png")}), {"missing/sure.png"});
    expect_refusal(with({left_}), {"left.png"});
    expect_refusal(with({path("map.png"), "--colormap", path("map.png")}), {"map.png"});
    expect_refusal(with({path("sure.png"), "--matcher", "gradient"}),
                   {"gradient", "knows no confidence"});
    EXPECT_FALSE(std::filesystem::exists(path("sure.png")));
}

TEST_F(MatchCommandTest, ExplainsItsPasses) {
    const ProgramResult machine =
        match({"--disparities", "16", "--matcher", "gradient", "--explain", "--json"});
    ASSERT_EQ(machine.status, 0) << machine.err;
    const auto json = nlohmann::json::parse(machine.out);
    EXPECT_GE(json.at("passes").size(), 4u);
    EXPECT_GT(json.at("gpu_bytes"), json.at("cost_volume_bytes"));
    const auto& modelled = json.at("modelled_frame_ms");
    EXPECT_GT(modelled.at("Raspberry Pi 4"), modelled.at("Raspberry Pi 5"));
    EXPECT_GT(modelled.at("Raspberry Pi 5"), 0);
    const ProgramResult person =
        match({"--disparities", "16", "--matcher", "gradient", "--explain"});
    EXPECT_NE(person.out.find("aggregation"), std::string::npos);
    EXPECT_NE(person.out.find("cost volumes"), std::string::npos);
}

TEST_F(MatchCommandTest, MatchesASmallerCopyAndExplainsWhatItTakes) {
    const ProgramResult result =
        match({"--disparities", "16", "--preset", "fast", "--width", "40", "--explain", "--json"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("width"), 40);
    EXPECT_EQ(json.at("height"), 31);
    const auto& reduce = json.at("passes").at(0);
    EXPECT_EQ(reduce.at("name"), "reduce");
    EXPECT_EQ(reduce.at("runs"), 2);
    EXPECT_EQ(reduce.at("bytes_moved"), 2 * 4 * (61 * 47 + 40 * 31));
    const cv::Mat1f px = read_pfm(output_);
    ASSERT_EQ(px.size(), cv::Size(40, 31));
    EXPECT_NEAR(px(15, 26), shift_px * 40.0 / 61, 0.5);
}

TEST_F(MatchCommandTest, RefusesToMatchMorePixelsThanThereAre) {
    expect_refusal(match({"--disparities", "16", "--width", "62"}), {"--width 62", "61 px wide"});
}

TEST_F(MatchCommandTest, RefusesMissingAndDamagedPictures) {
    expect_refusal(run({"match", path("none.png"), right_, "--disparities", "16", "-o", output_}),
                   {"none.png"});
    const std::string damaged = path("damaged.png");
    std::ofstream(damaged) << "no picture at all";
    expect_refusal(run({"match", left_, damaged, "--disparities", "16", "-o", output_}),
                   {"damaged.png", "not a picture"});
}

TEST_F(MatchCommandTest, RefusesPicturesOfDifferentSize) {
    const std::string small = path("small.png");
    write_colour_image(small, ColourImage(47, 60));
    expect_refusal(run({"match", left_, small, "--disparities", "16", "-o", output_}),
                   {"61x47", "60x47"});
}

TEST_F(MatchCommandTest, RefusesDisparitiesOutOfRange) {
    for (const char* count : {"0", "-3", "257"})
        expect_refusal(match({"--disparities", count}), {count, "1 to 256"});
    expect_refusal(match({"--disparities", "many"}), {"many"});
    expect_refusal(match({}), {"--disparities"});
}

TEST_F(MatchCommandTest, RefusesPicturesThatAreTooLargeNamingTheLimit) {
    const std::string wide = path("wide.png");
    write_colour_image(wide, ColourImage(20, 4097));
    expect_refusal(run({"match", wide, wide, "--disparities", "16", "-o", output_}),
                   {"4097x20", "4096"});
}

TEST_F(MatchCommandTest, RefusesUnknownNamesAndListsTheKnownOnes) {
    expect_refusal(match({"--disparities", "16", "--matcher", "magic"}), {"magic", "gradient"});
    expect_refusal(match({"--disparities", "16", "--preset", "best"}),
                   {"best", "fast", "balanced", "quality"});
}

TEST_F(MatchCommandTest, RefusesOutputsThatCannotBeWrittenBeforeItWritesAny) {
    const std::vector<std::string> pair = {"match", left_, right_, "--disparities", "16", "-o"};
    const auto with_output = [&](const std::vector<std::string>& words) {
        std::vector<std::string> arguments = pair;
        arguments.insert(arguments.end(), words.begin(), words.end());
        return run(arguments);
    };
    expect_refusal(with_output({path("missing/out.pfm")}), {"missing/out.pfm"});
    expect_refusal(with_output({path("out.tiff")}), {"out.tiff", ".pfm", ".png"});
    expect_refusal(with_output({left_}), {"left.png", "overwritten"});
    expect_refusal(match({"--disparities", "16", "--colormap", path("missing/map.png")}),
                   {"missing/map.png"});
    expect_refusal(match({"--disparities", "16", "--colormap", path("map.xyz")}), {"map.xyz"});
    expect_refusal(match({"--disparities", "16", "--colormap", right_}), {"right.png"});
    const std::string png = path("both.png");
    expect_refusal(with_output({png, "--colormap", png}), {"both.png"});
    EXPECT_FALSE(std::filesystem::exists(png));
}

TEST_F(MatchCommandTest, SaysWhatItTriedWhereThereIsNoGl) {
    const ProgramResult result = run_to_end(
        "/usr/bin/env", {"__EGL_VENDOR_LIBRARY_FILENAMES=" + path("no-vendor.json"), VANTAGE_RIG,
                         "match", left_, right_, "--disparities", "16", "-o", output_});
    expect_refusal(result, {"OpenGL ES 3.1", "surfaceless"});
}

}  // namespace
}  // namespace vantage
