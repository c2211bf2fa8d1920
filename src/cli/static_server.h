// A folder's files over HTTP/1.1, to be looked at by a browser on the same machine.
//
// It answers GET and HEAD and nothing else, gives away only regular files below its folder (where
// links lead is followed and checked, too), keeps no connection open, and takes one request at a
// time; a caller that is slow to ask keeps nobody waiting.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace mirrorball::cli {

/// What a request gets: complete but for the body of a file.
struct Response {
    int status = 200;
    std::string head;              ///< status line and fields, with the empty line at its end
    std::string text;              ///< the body of what is no file
    std::filesystem::path file{};  ///< whose bytes are the body
    bool has_body = true;          ///< not to a HEAD request
};

/// Of a request's first line and fields. `root` is canonical.
[[nodiscard]] Response respond(const std::filesystem::path& root, std::string_view request);

class StaticServer {
  public:
    /// Listens, on any port that is free if it is 0. \throws Error(Errc::cannot_read) if the folder
    /// is none, Error(Errc::unsupported) with the system's reason if it cannot listen
    StaticServer(const std::filesystem::path& root, const std::string& address, int port);
    ~StaticServer();
    StaticServer(const StaticServer&) = delete;
    StaticServer& operator=(const StaticServer&) = delete;

    [[nodiscard]] int port() const { return port_; }
    /// Answers until `stop` says so, which is asked several times a second.
    void run(const std::function<bool()>& stop);

  private:
    struct Connection {
        int socket;
        std::string request;
        std::int64_t deadline;  // milliseconds of a steady clock
    };
    void accept_one();
    // Is this connection done with?
    bool read_some(Connection& connection);
    void answer(const Connection& connection) const;

    std::filesystem::path root_;
    int socket_ = -1, port_ = 0;
    std::vector<Connection> connections_;
};

}  // namespace mirrorball::cli
