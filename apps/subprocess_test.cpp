// SPDX-License-Identifier: MIT
#include "apps/subprocess_test.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

namespace gn {

ScratchFolder::ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "gnomon-test-XXXXXX").string();
    path_ = mkdtemp(pattern.data());
}

ScratchFolder::~ScratchFolder() {
    std::error_code code;
    std::filesystem::remove_all(path_, code);
}

void ScratchFolder::write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
}

RunningCommand::RunningCommand(const std::vector<std::string>& arguments) {
    std::vector<std::string> words{gnomon_executable()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    const std::string out = folder_ / "out", err = folder_ / "err";
    pid_ = fork();
    if (pid_ == 0) {
        constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC;
        dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
        dup2(open(out.c_str(), flags, 0600), STDOUT_FILENO);
        dup2(open(err.c_str(), flags, 0600), STDERR_FILENO);
        execv(pointers.front(), pointers.data());
        _exit(127);
    }
}

void RunningCommand::signal(int number) const {
    kill(pid_, number);
}

bool RunningCommand::finished() {
    rusage usage{};
    if (!finished_ && wait4(pid_, &state_, WNOHANG, &usage) == pid_) {
        finished_ = true;
        peak_kilobytes_ = usage.ru_maxrss;
    }
    return finished_;
}

std::string RunningCommand::said() const {
    return file_text(folder_ / "out");
}

CommandResult RunningCommand::wait(int seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
    while (!finished()) {
        if (std::chrono::steady_clock::now() > end) {
            signal(SIGKILL);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return {WIFEXITED(state_) ? WEXITSTATUS(state_) : 128 + WTERMSIG(state_), file_text(folder_ / "out"),
            file_text(folder_ / "err"), peak_kilobytes_};
}

std::string gnomon_executable() {
    const char* named = std::getenv("GNOMON_EXECUTABLE");
    return named != nullptr ? named : GNOMON_EXECUTABLE;
}

CommandResult run_gnomon(const std::vector<std::string>& arguments) {
    return RunningCommand(arguments).wait();
}

void expect_has(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
        EXPECT_PRED_FORMAT2(testing::IsSubstring, part, text);
    }
}

std::string file_text(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
}

}  // namespace gn
