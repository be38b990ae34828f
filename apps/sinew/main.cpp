#include <cstdio>
#include <exception>
#include <new>

#include "apps/sinew/command.h"
#include "apps/sinew/files.h"
#include "apps/sinew/interrupt.h"
#include "engine/geometry/error.h"
#include "engine/io/io.h"

namespace sinew::app {

namespace {

constexpr Command commands[] = {
    {"info", "Shows what files hold: representation, points, faces, components, bounds, attributes",
     "  sinew info scan.ply\n"
     "  sinew info --json *.obj\n"
     "  sinew info 'walk.####.obj'\n"
     "  zcat scan.ply.gz | sinew info - --from ply",
     declare_info},
    {"deform", "Solves an edit and writes the bent file",
     "  sinew deform scan.ply --edit lift.json -o bent.ply\n"
     "  sinew deform bun.conf --edit ears.json -o bent/           (one file a scan)\n"
     "  sinew deform plane.obj --edit lift.json -o bent.obj --set nodes=300 --report r.json --pose lift.pose",
     declare_deform},
    {"blend", "Makes the shape between poses of a mesh, or beyond them",
     "  sinew blend stand.obj gallop.obj -w 0.5 -o between.obj\n"
     "  sinew blend stand.obj poses/ -w 0.3,0,1.2 -o mixed.obj --report r.json\n"
     "  sinew blend zebra.obj gallop.obj --of stand.obj -w 1 -o zebra-gallop.obj     (as the horse gallops)",
     declare_blend},
    {"apply", "Bends any other file of the same space with a solved edit, without solving",
     "  sinew deform coarse.ply --edit lift.json -o bent.ply --pose lift.pose\n"
     "  sinew apply lift.pose dense.ply -o dense-bent.ply\n"
     "  sinew apply lift.pose huge.ply -o huge-bent.ply --task 3/8      (one of 8 tasks that share the output)",
     declare_apply},
    {"submit", "Runs deform or apply as many tasks: a Slurm job array, under GNU parallel, or as printed commands",
     "  sinew submit --engine slurm --tasks 8 -- apply lift.pose huge.ply -o huge-bent.ply\n"
     "  sinew submit --engine slurm --tasks 8 --resume -- apply lift.pose huge.ply -o huge-bent.ply   (those that "
     "failed)\n"
     "  sinew submit --engine parallel --tasks 4 --jobs 2 -- deform run.####.obj --edit walk.json -o bent.####.obj\n"
     "  sinew submit --engine print --tasks 4 -- apply lift.pose huge.ply -o huge-bent.ply >commands.txt\n"
     "Partition, time and memory of Slurm: the environment of sbatch, as SBATCH_PARTITION.",
     declare_submit},
    {"diff", "Shows what changed between two files: point distances, attributes, everything else",
     "  sinew diff scan.ply bent.ply\n"
     "  sinew diff --json before.obj after.obj",
     declare_diff},
    {"convert", "Reads a file and writes it, changing nothing but the format",
     "  sinew convert scan.pcd scan.ply\n"
     "  sinew convert bun.conf merged.ply\n"
     "  sinew convert 'walk.####.obj' walk.pc2 --frames 1-48\n"
     "  cat mesh.off | sinew convert - mesh.obj --from off",
     declare_convert},
    {"render", "Draws a picture of a file, or of what an edit makes of it, without a display",
     "  sinew render scan.ply -o scan.png\n"
     "  sinew render plane.obj -o after.png --edit lift.json --show handles,fixed,ground --view iso --size 1600x900\n"
     "  sinew render scan.ply -o above.png --view 0,5,0,0,0,0\n"
     "  sinew render plane.obj -o stretch.png --edit lift.json --color stretch --colormap cool-warm\n"
     "  sinew render scan.ply -o turn.####.png --turntable 60",
     declare_render},
    {"formats", "Lists the formats that are read and written", "  sinew formats", declare_formats},
    {"methods", "Lists the methods of an edit and their settings", "  sinew methods\n  sinew methods --json",
     declare_methods},
};

int run(int argc, char** argv) {
  try {
    const int status = run_command_line(commands, argc, argv);
    if (std::fflush(stdout) != 0) {
      message("expected to write to standard output, found it closed or full");
      return Failed;
    }
    return interrupted() ? Interrupted : status;
  } catch (const UsageError& error) {
    message(error.what());
    return Usage;
  } catch (const io::Cancelled&) {
    return Interrupted;
  } catch (const InputError& error) {
    message(failed_place() + error.what());
    return interrupted() ? Interrupted : writing_failed() ? Failed : BadInput;
  } catch (const std::bad_alloc&) {
    message("expected enough memory, found too little");
    return Failed;
  } catch (const std::exception& error) {
    message(error.what());
    return Failed;
  }
}

}  // namespace

}  // namespace sinew::app

int main(int argc, char** argv) {
  sinew::app::handle_interrupts();
  return sinew::app::run(argc, argv);
}
