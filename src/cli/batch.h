// Several inputs by one command: where each result goes, and what becomes of a failure.
//
// Results lie in one folder under their inputs' names. All that can be known to fail is refused
// before the first is read; a file that fails later is reported, and the others still go through.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "output.h"
#include "progress.h"

namespace mirrorball::cli {

/// For the help of a verb that takes several inputs.
inline constexpr const char* kBatchNote =
    "Several inputs go to a folder, each under its own name without folder and ending "
    "(builtin:NAME "
    "as NAME, faces under what their names share, else their folder's name); two of one name are "
    "refused. An input that fails is reported and the others go on; the exit code is then that of "
    "the first failure.";

/// One input and the file or folder that it becomes.
struct Job {
    std::string input, output;
};

struct Batch {
    std::vector<Job> jobs;
    std::string folder;  ///< of all results, made where it is not there; empty for a single result
};

/// Whether -o names a folder for results: there is one, or the name ends in a slash.
[[nodiscard]] bool names_folder(const std::string& output);

/// One job per input, to `folder`/NAME`ending`. NAME is that of the input's file without folder and
/// ending, of builtin:NAME itself, of a set of faces what their names share, or else their
/// folder's. \throws Error(Errc::usage) if two results would have one name or one would replace an
/// input; Error(Errc::cannot_write) if nothing can be written to the folder
[[nodiscard]] Batch batch_into(const std::string& folder, const std::vector<std::string>& inputs,
                               const std::string& ending);

/// Does one job, prints its result unless --json is given, returns it for that.
using RunJob = std::function<Json(const Job& job, ProgressBar& bar)>;

/// Runs the jobs one after the other and returns the exit code. With --json one object is printed:
/// the result of a single job, else all results and failures. The error of a single job passes
/// through; of several, each error is reported at once, and the exit code is that of the first. An
/// interrupt ends all.
[[nodiscard]] int run_batch(const Batch& batch, const Shared& shared, const RunJob& run);

}  // namespace mirrorball::cli
