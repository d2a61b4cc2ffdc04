#include "host_app/web/web_desk.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/wire/codec/colour_codec.h"
#include "tests/support/eventually.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

class WebDeskTest : public testing::Test {
  protected:
    static WebRequest get(const std::string& path) {
        return {.method = "GET", .path = path, .host = "127.0.0.1:8443"};
    }
    static WebRequest post(const std::string& path, const std::string& body) {
        WebRequest request = get(path);
        request.method = "POST";
        request.is_from_page = true;
        request.body = body;
        return request;
    }
    static std::string header(const WebAnswer& answer, const std::string& name) {
        for (const auto& [key, value] : answer.headers)
            if (key == name) return value;
        return "";
    }
    auto commands() { return input_.take().input.commands; }

    OperatorInputBox input_;
    MonotonicTime now_ = monotonic_from_ns(1'000'000'000);
};

TEST_F(WebDeskTest, ServesThePageAndTheState) {
    WebDesk desk({}, input_);
    desk.show({.picture = {}, .set = {}, .state = R"({"a":1})"});
    const WebAnswer page = desk.answer(get("/"), now_);
    EXPECT_EQ(page.status, 200u);
    EXPECT_EQ(page.body, embedded_web_page().front().text);
    EXPECT_NE(header(page, "Content-Security-Policy").find("default-src 'none'"),
              std::string::npos);
    EXPECT_EQ(page.body.find("http://"), std::string::npos) << "it needs nothing else";
    EXPECT_EQ(desk.answer(get("/state"), now_).body, R"({"a":1})");
    EXPECT_EQ(desk.answer(get("/etc/passwd"), now_).status, 404u);
    EXPECT_EQ(desk.answer(get("/programme.jpg"), now_).status, 404u) << "no picture yet";
    WebRequest put = get("/state");
    put.method = "PUT";
    EXPECT_EQ(desk.answer(put, now_).status, 405u);
    EXPECT_EQ(desk.stats().requests, 5u);
    EXPECT_EQ(desk.stats().refused, 3u);
}

TEST_F(WebDeskTest, EncodesAPictureSixTimesASecondAtMost) {
    WebDesk desk({}, input_);
    desk.show({.picture = ColourImage(540, 1920, cv::Vec4b(200, 30, 30, 255)), .set = {}});
    const WebAnswer first = desk.answer(get("/programme.jpg"), now_);
    ASSERT_EQ(first.status, 200u);
    const std::span bytes = std::as_bytes(std::span(first.body));
    const ColourImage shown = JpegDecoder().decode(bytes, 960, 270);
    EXPECT_NEAR(shown(100, 100)[0], 200, 8);
    desk.show({.picture = ColourImage(540, 1920, cv::Vec4b(20, 30, 200, 255)), .set = {}});
    EXPECT_EQ(desk.answer(get("/programme.jpg"), now_ + 100ms).body, first.body);
    EXPECT_NE(desk.answer(get("/programme.jpg"), now_ + 200ms).body, first.body);
}

TEST_F(WebDeskTest, ShowsRigsWithTheirSharpness) {
    WebDesk desk({}, input_);
    auto set = std::make_shared<FrameSet>();
    auto frame = std::make_shared<RigFrame>();
    frame->colour = ColourImage(72, 96, cv::Vec4b(0, 0, 0, 255));
    for (int x = 0; x < 96; x += 2) frame->colour.col(x).setTo(cv::Vec4b(255, 255, 255, 255));
    set->slots.resize(1);
    set->slots[0].rig = "left";
    set->slots[0].frame = frame;
    desk.show({.picture = {}, .set = set});
    WebRequest request = get("/rig.jpg");
    request.query["rig"] = "left";
    const WebAnswer sharp = desk.answer(request, now_);
    ASSERT_EQ(sharp.status, 200u) << sharp.body;
    EXPECT_GT(std::stod(header(sharp, "X-Sharpness")), 100);
    request.query["rig"] = "<script>";
    EXPECT_EQ(desk.answer(request, now_).status, 404u);
}

/// A chessboard of 7 x 5 inner corners in the middle of a picture.
ColourImage chessboard_picture() {
    constexpr int square = 40, left = 120, top = 90;
    ColourImage picture(420, 560, cv::Vec4b(255, 255, 255, 255));
    for (int row = 0; row < 6; ++row)
        for (int column = 0; column < 8; ++column)
            if ((row + column) % 2 == 0)
                picture(cv::Rect(left + column * square, top + row * square, square, square))
                    .setTo(cv::Vec4b(0, 0, 0, 255));
    return picture;
}

TEST_F(WebDeskTest, FindsTheBoardInTheRigsPicture) {
    WebDesk desk({.boards = boards_of_option("7x5")}, input_);
    auto set = std::make_shared<FrameSet>();
    auto frame = std::make_shared<RigFrame>();
    frame->colour = chessboard_picture();
    set->slots.push_back({"left", frame});
    desk.show({.picture = {}, .set = set});
    WebRequest request = get("/board");
    EXPECT_EQ(desk.answer(request, now_).status, 404u) << "of which rig?";
    request.query["rig"] = "left";
    WebAnswer found;
    ASSERT_TRUE(eventually([&] {
        found = desk.answer(request, now_);
        return found.body != "null";
    }));
    ASSERT_EQ(found.status, 200u);
    const nlohmann::json json = nlohmann::json::parse(found.body);
    EXPECT_EQ(json["found"], true) << found.body;
    EXPECT_EQ(json["seen"], 35);
    EXPECT_EQ(json["of"], 35);
    EXPECT_NEAR(json["square_px"].get<double>(), 40, 0.5);
    double least_x = 1;
    for (const auto& corner : json["corners"]) least_x = std::min(least_x, corner[0].get<double>());
    EXPECT_NEAR(least_x, 160.0 / 560, 0.003);
    request.query["rig"] = "right";
    EXPECT_EQ(desk.answer(request, now_).status, 404u);
    WebDesk without({}, input_);
    EXPECT_NE(without.answer(request, now_).body.find("needs ?board="), std::string::npos);
}

TEST(BoardWatch, NamesWhyThereIsNoBoard) {
    const auto json = nlohmann::json::parse(
        board_sighting_json(GreyImage(200, 300, std::uint8_t{90}), boards_of_option("9x6")));
    EXPECT_EQ(json["found"], false);
    EXPECT_NE(json["why"], "");
    EXPECT_EQ(json["of"], 54);
    EXPECT_NE(thrown_sentence([] { (void)boards_of_option("nine"); }), "");
    EXPECT_NE(thrown_sentence([] { (void)boards_of_option("none.toml"); }).find("none.toml"),
              std::string::npos);
}

TEST_F(WebDeskTest, ObeysCommandsOfTheTableOnlyIfAllowed) {
    WebDesk reader({}, input_);
    EXPECT_EQ(reader.answer(post("/command", "live"), now_).status, 403u);
    EXPECT_TRUE(commands().empty());
    WebDesk desk({.has_control = true}, input_);
    EXPECT_EQ(desk.answer(post("/command", "shot 3"), now_).status, 204u);
    EXPECT_EQ(commands().size(), 1u);
    for (const char* words : {"", "shot", "shot 99", "rm -rf /", "live\nlive"})
        EXPECT_EQ(desk.answer(post("/command", words), now_).status, 400u) << words;
    EXPECT_EQ(desk.answer(post("/command", std::string(201, 'a')), now_).status, 400u);
    WebRequest foreign = post("/command", "live");
    foreign.is_from_page = false;
    EXPECT_EQ(desk.answer(foreign, now_).status, 403u) << "of a page of another site";
    WebRequest read = get("/command");
    read.body = "live";
    EXPECT_EQ(desk.answer(read, now_).status, 404u);
    EXPECT_TRUE(commands().empty());
    int obeyed = 0;
    for (int i = 0; i < 300; ++i)
        if (desk.answer(post("/command", "live"), now_).status == 204) ++obeyed;
    EXPECT_LE(obeyed, 100) << "a flood is limited";
}

TEST_F(WebDeskTest, ALocalPageIsNotReachedByForeignNames) {
    WebDesk desk({.has_control = true}, input_);
    for (const char* host : {"127.0.0.1:8443", "localhost", "localhost:1", "[::1]:8443"}) {
        WebRequest request = get("/state");
        request.host = host;
        EXPECT_EQ(desk.answer(request, now_).status, 200u) << host;
    }
    for (const char* host : {"", "evil.example", "localhost.evil.example", "[::2]", "10.0.0.1"}) {
        WebRequest request = get("/state");
        request.host = host;
        EXPECT_EQ(desk.answer(request, now_).status, 403u) << host;
    }
}

TEST_F(WebDeskTest, AsksForThePin) {
    WebDesk desk({.has_control = true, .pin = "1234", .is_local = false, .is_secure = true},
                 input_);
    EXPECT_EQ(desk.answer(get("/"), now_).status, 200u) << "the page asks for it";
    for (const char* path : {"/state", "/programme.jpg", "/rig.jpg"})
        EXPECT_EQ(desk.answer(get(path), now_).status, 401u) << path;
    EXPECT_EQ(desk.answer(post("/command", "live"), now_).status, 401u);
    EXPECT_EQ(desk.answer(post("/login", "1235"), now_).status, 401u);
    const WebAnswer in = desk.answer(post("/login", "1234"), now_);
    ASSERT_EQ(in.status, 204u);
    const std::string cookie = header(in, "Set-Cookie");
    EXPECT_NE(cookie.find("; HttpOnly; SameSite=Strict; Secure"), std::string::npos) << cookie;
    WebRequest request = get("/state");
    request.cookie = cookie.substr(8, 32);
    EXPECT_EQ(desk.answer(request, now_).status, 200u);
    request.cookie.back() ^= 1;
    EXPECT_EQ(desk.answer(request, now_).status, 401u);
    for (int i = 0; i < 5; ++i) (void)desk.answer(post("/login", "0000"), now_);
    EXPECT_EQ(desk.answer(post("/login", "1234"), now_).status, 429u) << "guesses are limited";
    EXPECT_EQ(desk.answer(post("/login", "1234"), now_ + 10s).status, 204u);
}

}  // namespace
}  // namespace vantage
