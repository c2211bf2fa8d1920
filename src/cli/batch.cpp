#include "batch.h"

#include <filesystem>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>

#include "command.h"
#include "options.h"
#include "result_folder.h"

namespace mirrorball::cli {
namespace {

namespace fs = std::filesystem;

// What all names begin with.
std::string shared_beginning(const std::vector<std::string>& names) {
    std::string beginning = names.front();
    for (const std::string& name : names) {
        std::size_t length = 0;
        while (length < std::min(beginning.size(), name.size()) &&
               beginning[length] == name[length])
            ++length;
        beginning.resize(length);
    }
    return beginning;
}

// "room_%s" and "room_" -> "room"
std::string without_face(std::string name) {
    if (const auto at = name.find("%s"); at != std::string::npos) name.erase(at, 2);
    const char* const separators = "-_. ";
    const std::size_t first = name.find_first_not_of(separators);
    if (first == std::string::npos) return "";
    return name.substr(first, name.find_last_not_of(separators) - first + 1);
}

std::string result_name(const std::string& input) {
    constexpr std::string_view builtin = "builtin:";
    if (input.starts_with(builtin)) return input.substr(builtin.size());
    std::error_code ignored;
    const bool one_file = input.find("%s") == std::string::npos &&
                          (input.find(',') == std::string::npos || fs::exists(input, ignored));
    if (one_file) return fs::path(input).stem().string();
    const std::vector<std::string> files = split(input, ',');
    std::vector<std::string> names;
    for (const std::string& file : files) names.push_back(fs::path(file).stem().string());
    const std::string name = without_face(shared_beginning(names));
    return name.empty() ? fs::absolute(files.front()).parent_path().filename().string() : name;
}

// Of what may not be there yet, by any path to it.
fs::path whole_path(const std::string& name) {
    std::error_code ignored;
    fs::path path = fs::weakly_canonical(name, ignored);
    return path.empty() ? fs::path(name) : path;
}

void check_names(const std::vector<Job>& jobs) {
    std::map<fs::path, std::string> inputs, outputs;
    for (const Job& job : jobs) inputs[whole_path(job.input)] = job.input;
    for (const Job& job : jobs) {
        const fs::path path = whole_path(job.output);
        const auto [other, is_new] = outputs.emplace(path, job.input);
        if (!is_new) {
            throw Error(Errc::usage, fmt::format("{} and {} would both become {}; rename one or "
                                                 "give them different folders",
                                                 other->second, job.input, job.output));
        }
        if (inputs.contains(path)) {
            throw Error(Errc::usage, fmt::format("the result of {} would replace the input {}",
                                                 job.input, inputs[path]));
        }
    }
}

}  // namespace

bool names_folder(const std::string& output) {
    std::error_code ignored;
    return output.ends_with('/') || fs::is_directory(output, ignored);
}

Batch batch_into(const std::string& folder, const std::vector<std::string>& inputs,
                 const std::string& ending) {
    Batch batch{{}, folder};
    for (const std::string& input : inputs) {
        batch.jobs.push_back(
            {input, (without_slash(folder) / (result_name(input) + ending)).string()});
    }
    check_names(batch.jobs);
    check_result_folder(folder);
    return batch;
}

int run_batch(const Batch& batch, const Shared& shared, const RunJob& run) {
    const ResultFolder folder(batch.folder);
    ProgressBar bar(shared, static_cast<int>(batch.jobs.size()));
    if (batch.jobs.size() == 1) {
        const Json result = run(batch.jobs.front(), bar);
        if (shared.json) print_json(result);
        return 0;
    }
    int exit_code = 0;
    Json results = Json::array(), failures = Json::array();
    for (std::size_t i = 0; i < batch.jobs.size(); ++i) {
        bar.begin_part(static_cast<int>(i));
        const Job& job = batch.jobs[i];
        try {
            results.push_back(run(job, bar));
        } catch (...) {
            const Failure failure = current_failure();
            if (failure.interrupted) throw;
            bar.hide();
            tell_failure(failure);
            failures.push_back({{"input", job.input}, {"error", failure.message}});
            if (exit_code == 0) exit_code = failure.exit_code;
        }
    }
    bar.hide();
    if (!failures.empty()) {
        fmt::print(stderr, "mirrorball: {} of {} inputs failed\n", failures.size(),
                   batch.jobs.size());
    }
    if (shared.json) print_json({{"results", results}, {"failures", failures}});
    return exit_code;
}

}  // namespace mirrorball::cli
