// The library example of README.md, word for word.
#include <mirrorball/io.h>
#include <mirrorball/resample.h>

using namespace mirrorball;

int main() {
    const EnvironmentMap sky = read_map("builtin:sunset").map;
    EnvironmentMap cube = resample(sky, Projection::cube, 64, default_axes(Projection::cube));
    append_mip_levels(cube);
    write_map("sunset.ktx2", cube);
}
