#include "static_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <mirrorball/error.h>

namespace mirrorball::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestRequest = 16384, kMostConnections = 64;
// How long a caller may take to ask, and to take each piece of the answer.
constexpr int kPatienceSeconds = 10, kStopCheckMilliseconds = 200;

std::int64_t now() {
    using namespace std::chrono;
    return duration_cast<milliseconds>(steady_clock::now().time_since_epoch()).count();
}

std::string reason(int error) {
    return std::generic_category().message(error);
}

std::string_view reason_phrase(int status) {
    switch (status) {
        case 200:
            return "OK";
        case 301:
            return "Moved Permanently";
        case 400:
            return "Bad Request";
        case 404:
            return "Not Found";
        case 405:
            return "Method Not Allowed";
        default:
            return "Request Header Fields Too Large";
    }
}

std::string_view media_type(const fs::path& file) {
    constexpr std::pair<std::string_view, std::string_view> kTypes[] = {
        {".html", "text/html; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".mjs", "text/javascript; charset=utf-8"},
        {".json", "application/json"},
        {".wasm", "application/wasm"},
        {".png", "image/png"},
        {".jpg", "image/jpeg"},
        {".svg", "image/svg+xml"},
        {".txt", "text/plain; charset=utf-8"},
        {".md", "text/plain; charset=utf-8"}};
    const std::string ending = file.extension().string();
    for (const auto& [known, type] : kTypes)
        if (ending == known) return type;
    return "application/octet-stream";
}

void write_head(Response& response, std::string_view type, std::uint64_t length,
                std::string_view more = "") {
    response.head = fmt::format(
        "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\n{}"
        "X-Content-Type-Options: nosniff\r\nCache-Control: no-cache\r\nConnection: close\r\n\r\n",
        response.status, reason_phrase(response.status), type, length, more);
}

Response refusal(int status, std::string_view more = "") {
    Response response{.status = status, .head = {}, .text = {}};
    response.text = fmt::format("{} {}\n", status, reason_phrase(status));
    write_head(response, "text/plain; charset=utf-8", response.text.size(), more);
    return response;
}

std::optional<int> hexadecimal(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return std::nullopt;
}

// "%20" as a blank; none of what is not written so, or means a zero byte.
std::optional<std::string> decoded(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        char c = text[i];
        if (c == '%') {
            if (i + 2 >= text.size()) return std::nullopt;
            const auto high = hexadecimal(text[i + 1]), low = hexadecimal(text[i + 2]);
            if (!high || !low) return std::nullopt;
            c = static_cast<char>(16 * *high + *low);
            i += 2;
        }
        if (c == '\0') return std::nullopt;
        result += c;
    }
    return result;
}

bool is_below(const fs::path& root, const fs::path& path) {
    const auto [end, unused] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
    return end == root.end();
}

// Answers before anything is opened: a name that leaves the folder gets what a missing one gets.
Response respond_to(const fs::path& root, const std::string& name) {
    for (const fs::path& part : fs::path(name))
        if (part == "..") return refusal(404);
    std::error_code error;
    fs::path file = fs::canonical(root / fs::path(name).relative_path(), error);
    if (error || !is_below(root, file)) return refusal(404);
    if (fs::is_directory(file, error)) {
        // So that the page's relative addresses work.
        if (name.back() != '/')
            return refusal(301, fmt::format("Location: ./{}/\r\n", file.filename().string()));
        file = fs::canonical(file / "index.html", error);
        if (error || !is_below(root, file)) return refusal(404);
    }
    if (!fs::is_regular_file(file, error)) return refusal(404);
    const std::uint64_t size = fs::file_size(file, error);
    if (error || access(file.c_str(), R_OK) != 0) return refusal(404);
    Response response;
    response.file = file;
    write_head(response, media_type(file), size);
    return response;
}

bool send_all(int socket, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t count = send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return true;
}

}  // namespace

Response respond(const fs::path& root, std::string_view request) {
    const std::string_view line = request.substr(0, request.find("\r\n"));
    const std::size_t first = line.find(' '), last = line.rfind(' ');
    if (first == std::string_view::npos || last <= first + 1 ||
        !line.substr(last + 1).starts_with("HTTP/1."))
        return refusal(400);
    const std::string_view method = line.substr(0, first);
    std::string_view target = line.substr(first + 1, last - first - 1);
    if (method != "GET" && method != "HEAD") return refusal(405, "Allow: GET, HEAD\r\n");
    target = target.substr(0, target.find_first_of("?#"));
    const std::optional<std::string> name = decoded(target);
    if (!name || !name->starts_with('/')) return refusal(400);
    Response response = respond_to(root, *name);
    response.has_body = method != "HEAD";
    return response;
}

StaticServer::StaticServer(const fs::path& root, const std::string& address, int port) {
    std::error_code error;
    root_ = fs::canonical(root, error);
    if (error || !fs::is_directory(root_)) {
        throw Error(Errc::cannot_read,
                    fmt::format("{}: is no folder that can be served", root.string()));
    }
    sockaddr_in where{};
    where.sin_family = AF_INET;
    where.sin_port = htons(static_cast<std::uint16_t>(port));
    if (inet_pton(AF_INET, address.c_str(), &where.sin_addr) != 1) {
        throw Error(Errc::usage,
                    fmt::format("\"{}\" is no address; expected one as 127.0.0.1", address));
    }
    socket_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const int yes = 1;
    if (socket_ >= 0) setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    socklen_t size = sizeof(where);
    auto* const name = reinterpret_cast<sockaddr*>(&where);
    if (socket_ < 0 || bind(socket_, name, size) != 0 || listen(socket_, SOMAXCONN) != 0 ||
        getsockname(socket_, name, &size) != 0) {
        const int code = errno;
        if (socket_ >= 0) close(socket_);
        throw Error(Errc::unsupported,
                    fmt::format("{}:{} cannot be listened on ({})", address, port, reason(code)));
    }
    port_ = ntohs(where.sin_port);
}

StaticServer::~StaticServer() {
    for (const Connection& connection : connections_) close(connection.socket);
    close(socket_);
}

void StaticServer::run(const std::function<bool()>& stop) {
    while (!stop()) {
        std::vector<pollfd> waiting{{socket_, POLLIN, 0}};
        // With no room for more, those who ask wait in the system's queue.
        if (connections_.size() >= kMostConnections) waiting.front().events = 0;
        for (const Connection& connection : connections_)
            waiting.push_back({connection.socket, POLLIN, 0});
        if (poll(waiting.data(), waiting.size(), kStopCheckMilliseconds) < 0 && errno != EINTR)
            return;
        // From the last, as those that are done with go.
        for (std::size_t i = connections_.size(); i-- > 0;) {
            const bool has_something = waiting[i + 1].revents != 0;
            Connection& connection = connections_[i];
            if (has_something ? read_some(connection) : now() > connection.deadline) {
                close(connection.socket);
                connections_.erase(connections_.begin() + static_cast<std::ptrdiff_t>(i));
            }
        }
        if (waiting.front().revents & POLLIN) accept_one();
    }
}

void StaticServer::accept_one() {
    const int socket = accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) return;
    const timeval patience{kPatienceSeconds, 0};
    setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
    connections_.push_back({socket, {}, now() + 1000 * kPatienceSeconds});
}

bool StaticServer::read_some(Connection& connection) {
    std::array<char, 4096> bytes;
    const ssize_t count = recv(connection.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return false;
    if (count <= 0) return true;
    connection.request.append(bytes.data(), static_cast<std::size_t>(count));
    const bool whole = connection.request.find("\r\n\r\n") != std::string::npos;
    if (!whole && connection.request.size() <= kLongestRequest) return false;
    answer(connection);
    return true;
}

void StaticServer::answer(const Connection& connection) const {
    const bool is_long = connection.request.size() > kLongestRequest;
    const Response response = is_long ? refusal(431) : respond(root_, connection.request);
    if (!send_all(connection.socket, response.head) || !response.has_body) return;
    if (response.file.empty()) {
        send_all(connection.socket, response.text);
        return;
    }
    std::ifstream file(response.file, std::ios::binary);
    std::array<char, 65536> bytes;
    while (file.read(bytes.data(), bytes.size()), file.gcount() > 0) {
        if (!send_all(connection.socket, {bytes.data(), static_cast<std::size_t>(file.gcount())}))
            return;
    }
}

}  // namespace mirrorball::cli
