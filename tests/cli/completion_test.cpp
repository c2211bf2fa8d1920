// The completion script, in a real bash.
#include "program.h"

namespace mirrorball {
namespace {

// What bash would offer at the end of `line`, one word per line.
std::string completed(const std::string& line) {
    static const std::string kAsk = R"(
        source "$1"
        COMP_LINE="$2" COMP_POINT=${#2}
        read -ra COMP_WORDS <<< "$2"
        [[ "$2" == *" " ]] && COMP_WORDS+=("")
        COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
        _mirrorball
        printf '%s\n' "${COMPREPLY[@]}")";
    const TemporaryFolder folder;
    write_contents(folder / "script", run({"completion", "bash"}).out);
    const Outcome outcome =
        Program({"/bin/bash", "-c", kAsk, "bash", (folder / "script").string(), line}).wait();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return "\n" + outcome.out;
}

void expect_offer(const std::string& line, const std::string& word) {
    EXPECT_NE(completed(line).find("\n" + word + "\n"), std::string::npos)
        << line << completed(line);
}

TEST(Completion, OffersVerbsOptionsAndValues) {
    expect_offer("mirrorball ", "bake");
    expect_offer("mirrorball co", "convert");
    expect_offer("mirrorball co", "compare");
    expect_offer("mirrorball convert a.hdr --to ", "dual-paraboloid");
    expect_offer("mirrorball convert a.hdr --to oct", "octahedral");
    expect_offer("mirrorball convert --ro", "--rotate");
    expect_offer("mirrorball bake a.hdr --mapping f", "filament");
    expect_offer("mirrorball info --axes bl", "blender");
    expect_offer("mirrorball sky s", "sunset");
    expect_offer("mirrorball irradiance-sh a.hdr --scale t", "three.js");
    expect_offer("mirrorball brdf brushed-g", "brushed-gold");
    expect_offer("mirrorball fresnel metal=", "metal=gold");
    expect_offer("mirrorball dfg --channels fi", "filament");
    expect_offer("mirrorball bake a.hdr --fresnel metal=", "metal=gold");
    expect_offer("mirrorball completion ", "bash");
    EXPECT_EQ(completed("mirrorball convert a.hdr --to oct").find("cube"), std::string::npos);
}

// bash takes a colon for the end of a word and replaces only what stands behind it.
TEST(Completion, CutsWhatStandsBeforeAColon) {
    expect_offer("mirrorball info builtin:su", "sunset");
    expect_offer("mirrorball prefilter a.hdr --lobe ggx:", "0.5");
}

}  // namespace
}  // namespace mirrorball
