#include "tests/processes/live/attended.h"

#include <sstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/support/eventually.h"

namespace vantage {

nlohmann::json event_of(const std::string& out, const std::string& name, std::size_t skip) {
    std::istringstream lines(out);
    for (std::string line; std::getline(lines, line);) {
        const nlohmann::json event = nlohmann::json::parse(line, nullptr, false);
        if (!event.is_discarded() && event["event"] == name && skip-- == 0) return event;
    }
    return {};
}

Attended::Attended(const std::string& program, const std::string& arguments,
                   const std::filesystem::path& folder, const std::string& name)
    : pipe_(folder / (name + ".in")) {
    if (mkfifo(pipe_.c_str(), 0600) != 0) throw std::runtime_error("no pipe");
    std::filesystem::create_directories(folder / name);
    // It is opened for reading and writing, so that neither end blocks.
    fd_ = UniqueFd(open(pipe_.c_str(), O_RDWR | O_CLOEXEC));
    child_ = std::make_unique<ChildProgram>(
        "/bin/sh",
        std::vector<std::string>{
            "-c", fmt::format("exec '{}' {} <'{}'", program, arguments, pipe_.string())},
        folder / name);
}

nlohmann::json Attended::wait_for(const std::string& event, std::size_t skip) const {
    nlohmann::json found;
    if (eventually([&] { return !(found = event_of(child_->out(), event, skip)).is_null(); }))
        return found;
    ADD_FAILURE() << "no " << event << " in: " << child_->out() << child_->err();
    return {{"code", ""}};
}

void Attended::type(const std::string& line) const {
    const std::string text = line + "\n";
    ASSERT_EQ(write(fd_.get(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
}

void compare_codes(const Attended& host, const Attended& rig, std::size_t codes_before) {
    const std::string at_rig = rig.wait_for("code")["code"];
    const std::string at_host = host.wait_for("code", codes_before)["code"];
    EXPECT_EQ(at_rig, at_host);
    host.type(at_rig);
    rig.type(at_host);
}

}  // namespace vantage
