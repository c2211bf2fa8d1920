// mirrorball serve: the page for browsers, or any folder, on this machine.
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>

#include "interrupt.h"
#include "output.h"
#include "page_folder.h"
#include "static_server.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::string folder, address = "127.0.0.1";
    int port = 8000;
};

fs::path page_folder() {
    if (const auto folder = page_folder_with("index.html")) return *folder;
    throw Error(Errc::usage,
                "DIR is missing, and the page is not where the program looks for it; `make web` "
                "builds it in build/web/page");
}

int run(const Options& options, const Shared& shared) {
    const fs::path folder = options.folder.empty() ? page_folder() : fs::path(options.folder);
    StaticServer server(folder, options.address, options.port);
    const std::string address = fmt::format("http://{}:{}/", options.address, server.port());
    shared.json ? print_json(Json{{"address", address}, {"folder", folder.string()}})
                : print(address + "\n");
    tell(shared, "Ctrl-C ends it");
    server.run(interrupted);
    return 0;
}

}  // namespace

Command serve_command(Shared& shared) {
    auto options = std::make_shared<Options>();
    Command command{.name = "serve", .summary = "Shows the page for browsers on this machine."};
    command.arguments = {{"DIR",
                          "another folder of files, such as a report of bake's",
                          text(options->folder),
                          {{}, false, true},
                          false}};
    command.options = {
        {"--port", "N", "0 takes any that is free [8000]", whole_number(options->port, 0, 65535)},
        {"--address", "A", "who may ask: 127.0.0.1 is this machine, 0.0.0.0 anyone [127.0.0.1]",
         text(options->address)}};
    add_shared_options(command, shared);
    command.notes = {
        "Prints the page's address and answers until it is interrupted. Only files below the "
        "folder "
        "are given away."};
    command.examples = {"mirrorball serve", "mirrorball serve demo --port 0"};
    command.run = [options, &shared] { return run(*options, shared); };
    return command;
}

}  // namespace mirrorball::cli
