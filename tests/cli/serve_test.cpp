// mirrorball serve, asked over real sockets.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <thread>

#include "program.h"

namespace mirrorball {
namespace {

using namespace std::chrono_literals;

class Serve : public testing::Test {
  protected:
    void SetUp() override {
        std::filesystem::create_directories(folder_ / "public/sub");
        write_contents(folder_ / "public/index.html", "<p>the page");
        write_contents(folder_ / "public/a b.js", "1;");
        write_contents(folder_ / "public/module.wasm", std::string("\0asm", 4));
        write_contents(folder_ / "public/large.bin", std::string(3'000'000, 'x'));
        write_contents(folder_ / "public/sub/index.html", "<p>below");
        write_contents(folder_ / "secret.txt", "secret");
        std::filesystem::create_symlink("../secret.txt", folder_ / "public/link.txt");
        out_ = (folder_ / "address").string();
        program_.emplace(
            command({"serve", (folder_ / "public").string(), "--port", "0", "--quiet"}), out_);
        for (int i = 0; i < 500 && contents(out_).find('\n') == std::string::npos; ++i)
            std::this_thread::sleep_for(10ms);
        const std::string address = contents(out_);
        ASSERT_EQ(address.compare(0, 17, "http://127.0.0.1:"), 0) << address;
        port_ = std::stoi(address.substr(17));
    }
    void TearDown() override {
        if (!program_) return;
        program_->send(SIGINT);
        program_->wait();
    }

    [[nodiscard]] int connected() const {
        const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in where{};
        where.sin_family = AF_INET;
        where.sin_port = htons(static_cast<std::uint16_t>(port_));
        where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(connect(socket, reinterpret_cast<sockaddr*>(&where), sizeof(where)), 0);
        return socket;
    }

    // Everything that comes back until the other side closes.
    [[nodiscard]] std::string raw(const std::string& request) const {
        const int socket = connected();
        EXPECT_EQ(send(socket, request.data(), request.size(), MSG_NOSIGNAL),
                  static_cast<ssize_t>(request.size()));
        std::string answer;
        char bytes[4096];
        for (ssize_t count; (count = recv(socket, bytes, sizeof(bytes), 0)) > 0;)
            answer.append(bytes, static_cast<std::size_t>(count));
        close(socket);
        return answer;
    }
    [[nodiscard]] std::string get(const std::string& target) const {
        return raw("GET " + target + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    }
    static std::string status(const std::string& answer) { return answer.substr(9, 3); }
    static std::string body(const std::string& answer) {
        return answer.substr(answer.find("\r\n\r\n") + 4);
    }

    TemporaryFolder folder_;
    std::string out_;
    std::optional<Program> program_;
    int port_ = 0;
};

TEST_F(Serve, GivesFilesWithTheirTypes) {
    const std::string page = get("/");
    EXPECT_EQ(status(page), "200");
    EXPECT_EQ(body(page), "<p>the page");
    EXPECT_NE(page.find("Content-Type: text/html"), std::string::npos);
    EXPECT_NE(page.find("Content-Length: 11\r\n"), std::string::npos);
    EXPECT_EQ(body(get("/a%20b.js?query")), "1;");
    EXPECT_NE(get("/module.wasm").find("Content-Type: application/wasm"), std::string::npos);
    EXPECT_EQ(body(get("/module.wasm")), std::string("\0asm", 4));
    EXPECT_EQ(body(get("/large.bin")).size(), 3'000'000u);
    EXPECT_EQ(body(get("/sub/")), "<p>below");
    EXPECT_EQ(status(get("/sub")), "301");
    const std::string head = raw("HEAD / HTTP/1.1\r\n\r\n");
    EXPECT_EQ(status(head), "200");
    EXPECT_EQ(body(head), "");
}

TEST_F(Serve, GivesNothingFromOutsideItsFolder) {
    for (const char* target :
         {"/../secret.txt", "/sub/../../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt",
          "/sub/%2e%2e%2f%2e%2e%2fsecret.txt", "//../secret.txt", "/link.txt", "/./../secret.txt",
          "/etc/passwd", "//etc/passwd", "/nothing"}) {
        const std::string answer = get(target);
        EXPECT_EQ(status(answer), "404") << target;
        EXPECT_EQ(answer.find("secret\n"), std::string::npos);
        EXPECT_EQ(body(answer), "404 Not Found\n") << target;
    }
}

TEST_F(Serve, RefusesWhatIsNoRequest) {
    EXPECT_EQ(status(raw("POST / HTTP/1.1\r\n\r\n")), "405");
    EXPECT_EQ(status(raw("rubbish\r\n\r\n")), "400");
    EXPECT_EQ(status(raw("GET / SPDY/9\r\n\r\n")), "400");
    EXPECT_EQ(status(get("/%zz")), "400");
    EXPECT_EQ(status(get("/a%00b")), "400");
    EXPECT_EQ(status(get("relative")), "400");
    EXPECT_EQ(status(raw("GET / HTTP/1.1\r\nX: " + std::string(20'000, 'x'))), "431");
}

TEST_F(Serve, ASilentCallerKeepsNobodyWaiting) {
    const int silent = connected(), slow = connected();
    EXPECT_EQ(send(slow, "GET ", 4, MSG_NOSIGNAL), 4);
    EXPECT_EQ(status(get("/")), "200");
    close(silent);
    close(slow);
    EXPECT_EQ(status(get("/")), "200");
}

TEST_F(Serve, EndsWhenInterrupted) {
    program_->send(SIGINT);
    EXPECT_EQ(program_->wait().code, 0);
    program_.reset();
}

// As a shell's Ctrl-Z and fg do, a debugger, or a leak sanitizer that stops all threads.
TEST_F(Serve, EndsWellThoughStoppedMeanwhile) {
    program_->send(SIGINT);
    std::this_thread::sleep_for(20ms);
    program_->send(SIGSTOP);
    program_->send(SIGCONT);
    EXPECT_EQ(program_->wait().code, 0);
    program_.reset();
}

TEST(ServeUsage, SaysWhatIsWrong) {
    const TemporaryFolder folder;
    expect_refused({"serve", (folder / "none").string()}, 3, "is no folder that can be served");
    expect_refused({"serve", folder.path().string(), "--address", "here"}, 2,
                   "expected one as 127.0.0.1");
    expect_refused({"serve", folder.path().string(), "--port", "70000"}, 2, "--port");
}

}  // namespace
}  // namespace mirrorball
