#include "rig_firmware/clock/ptp4l_client.h"

#include <array>
#include <cstring>
#include <thread>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/base/files/unique_fd.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

std::vector<std::byte> bytes(std::initializer_list<int> values) {
    std::vector<std::byte> result;
    for (const int value : values) result.push_back(static_cast<std::byte>(value));
    return result;
}

/// An answer as ptp4l sends it: the question, made a response, with its data.
std::vector<std::byte> answer_to(std::vector<std::byte> question,
                                 const std::vector<std::byte>& data) {
    constexpr std::size_t action_at = 46, tlv_length_at = 51;
    question[action_at] = std::byte{2};
    question[tlv_length_at] = static_cast<std::byte>(2 + data.size());
    question.insert(question.end(), data.begin(), data.end());
    return question;
}

std::vector<std::byte> current_data() {
    // One step; -150.5 ns from the master (in 1/65536 ns); 1000 ns of path.
    return bytes({0, 1, 0xff, 0xff, 0xff, 0xff, 0xff, 0x69, 0x80, 0, 0, 0, 0, 0, 0x03, 0xe8, 0, 0});
}

std::vector<std::byte> port_data(int state) {
    return bytes({1, 2, 3, 4, 5, 6, 7, 8, 0, 1, state, 0, 0, 0, 0, 0});
}

TEST(Ptp4lClient, ReadsOffsetDelayAndPortState) {
    PtpState state;
    ASSERT_TRUE(read_ptp_answer(answer_to(ptp_get_message(PtpDataSet::current, 1), current_data()),
                                PtpDataSet::current, state));
    ASSERT_TRUE(read_ptp_answer(answer_to(ptp_get_message(PtpDataSet::port, 2), port_data(9)),
                                PtpDataSet::port, state));
    EXPECT_EQ(state.steps_removed, 1);
    EXPECT_EQ(state.offset_ns, -150.5);
    EXPECT_EQ(state.path_delay_ns, 1000);
    EXPECT_EQ(state.port_state, "SLAVE");
    EXPECT_TRUE(state.disciplines({.was_set_lately = true}));
}

TEST(Ptp4lClient, KnowsASystemClockThatNobodySetsByTheInterfaces) {
    const KernelClock left_alone{.tai_offset_s = 0, .is_synchronized = true};
    PtpState state{.port_state = "SLAVE"};
    EXPECT_TRUE(state.is_in_step());
    EXPECT_FALSE(state.disciplines(left_alone));
    state.port_state = "MASTER";
    EXPECT_TRUE(state.disciplines(left_alone)) << "it is what the others follow";
}

TEST(Ptp4lClient, KnowsAClockThatFollowsNobody) {
    PtpState state;
    ASSERT_TRUE(read_ptp_answer(answer_to(ptp_get_message(PtpDataSet::port, 2), port_data(4)),
                                PtpDataSet::port, state));
    EXPECT_EQ(state.port_state, "LISTENING");
    EXPECT_FALSE(state.is_in_step());
    EXPECT_FALSE(state.disciplines({.was_set_lately = true}));
}

TEST(Ptp4lClient, LeavesOutWhatIsNoAnswer) {
    PtpState state;
    const auto question = ptp_get_message(PtpDataSet::current, 1);
    EXPECT_FALSE(read_ptp_answer(question, PtpDataSet::current, state)) << "the question itself";
    const auto whole = answer_to(question, current_data());
    EXPECT_FALSE(read_ptp_answer(whole, PtpDataSet::port, state)) << "of another data set";
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_FALSE(read_ptp_answer(std::span(whole).first(size), PtpDataSet::current, state))
            << size;
}

TEST(Ptp4lClient, AsksThroughTheManagementSocket) {
    const TemporaryFolder folder;
    const std::string path = (folder.path() / "ptp4l").string();
    EXPECT_FALSE(read_ptp4l(path).has_value()) << "no ptp4l there";
    const UniqueFd server(::socket(AF_UNIX, SOCK_DGRAM, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    ASSERT_EQ(::bind(server.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_FALSE(read_ptp4l(path, std::chrono::milliseconds(20)).has_value())
        << "it does not answer";
    std::array<std::byte, 100> question{};
    while (::recv(server.get(), question.data(), question.size(), MSG_DONTWAIT) > 0) {
    }
    std::jthread ptp4l([&] {
        for (const auto& data : {current_data(), port_data(9)}) {
            sockaddr_un client{};
            socklen_t size = sizeof client;
            const ssize_t length = ::recvfrom(server.get(), question.data(), question.size(), 0,
                                              reinterpret_cast<sockaddr*>(&client), &size);
            const auto reply = answer_to({question.begin(), question.begin() + length}, data);
            ::sendto(server.get(), reply.data(), reply.size(), 0,
                     reinterpret_cast<sockaddr*>(&client), size);
        }
    });
    const auto state = read_ptp4l(path, std::chrono::seconds(10));
    ASSERT_TRUE(state.has_value());
    EXPECT_EQ(state->port_state, "SLAVE");
    EXPECT_EQ(state->offset_ns, -150.5);
}

}  // namespace
}  // namespace vantage
