// Texts of --help that are longer than a line: of an option that several subcommands have, and the examples at the end.
#pragma once

namespace cli {

inline constexpr const char* camera_text =
    "auto, the number of a camera of the scene, ex,ey,ez,tx,ty,tz,fovy (eye, target, vertical degrees), or the 32 "
    "numbers that a result.json has as scene.view: view and projection matrix, column by column";

inline constexpr const char* general_help = R"(Examples:
  ropsim compare scene.glb --out report        the usual designs; then open report/report.html
  ropsim compare gen:blob --k 8 --entry z      a scene made by rule
  ropsim run scene.glb --design blender        every counter of one design
  ropsim truth scene.glb --check --out truth   the frame by ray tracing, beside the rasterized one
  ropsim accuracy scene.glb --sweep k=1,2,4    a method's error beside its run time
  ropsim geometry scene.glb --gpu g70          what limits the geometry feed, and what helps
  ropsim validate geometry                     the model beside published measurements
  ropsim study batching                        one question, a table and a plot
  ropsim sensitivity scene.glb                 which assumptions a comparison depends on
  ropsim stability                             stiff and extreme cases, each beside exact arithmetic
  ropsim capture scene.glb -o scene.rtrace     the frame in one file; ropsim replay scene.rtrace runs it
  ropsim record -o game.rtrace -- game         frames that a program draws with OpenGL, in one file
  ropsim describe designs                      what can be chosen, and what it means)";

inline constexpr const char* compare_help = R"(Examples:
  ropsim compare scene.glb
  ropsim compare scene.glb --designs existing,scoreboard --out report
  ropsim compare scene.glb --designs all --gpu g71 --k 8 --size 1024x768 --no-images --out report
  ropsim compare scene.glb --designs 'existing?visibility=rop_cache,blender?rop.queue=128,blender'
  ropsim compare scene.glb --designs interlock,scoreboard,blender --equal-area 300000
  ropsim compare scene.glb --set scoreboard.granularity=tile8 --set rop.queue=32 --json > result.json)";

inline constexpr const char* run_help = R"(Examples:
  ropsim run scene.glb --design existing
  ropsim run scene.glb --design 'scoreboard?side_buffer=128'
  ropsim run scene.glb --design scoreboard --timeline --out report
  ropsim run "gen:stack?n=64" --design blender --size 64x64 --json)";

inline constexpr const char* truth_help = R"(Examples:
  ropsim truth scene.glb --out truth
  ropsim truth scene.glb --light 0,9,0,1,0,0,0,0,1 --rays 1000 --size 800x600 --out shadows)";

inline constexpr const char* geometry_help = R"(Examples:
  ropsim geometry scene.glb --gpu g70
  ropsim geometry scene.glb --gpu r420 --prepare reorder --prepare 'batch?vertices=4096'
  ropsim geometry scene.glb --prepare recommended --export prepared.glb
  ropsim geometry gen:grass --gpu nv43 --submission client_arrays --json)";

inline constexpr const char* validate_help = R"(Examples:
  ropsim validate geometry
  ropsim validate geometry --gpus g70,r420 --leave-one-out --out validation
  ropsim validate peeling --out peeling
  ropsim validate deferred --gpus gtx760 --lights 2,4 --out deferred)";

inline constexpr const char* calibrate_help = R"(Examples:
  ropsim calibrate geometry                      what the measurements say, beside what the files say
  ropsim calibrate geometry --gpus g70 --write models/gpus
  ropsim calibrate geometry --folds 5            how well rows are predicted that had no part in a fit
  ropsim calibrate peeling --fidelity detailed --write models/gpus)";

inline constexpr const char* study_help = R"(Examples:
  ropsim study                                   the studies there are
  ropsim study batching --out batching
  ropsim study tolerable_artefacts --out artefacts
  ropsim study batching --gpus g70 --fidelity estimate
  ropsim study my_study.toml)";

inline constexpr const char* sensitivity_help = R"(Examples:
  ropsim sensitivity scene.glb --size 256x256 --out sensitivity
  ropsim sensitivity scene.glb --parameters rop.queue,memory --factor 4
  ropsim sensitivity gen:discs --designs 'interlock,blender,blender?rop.queue=128' --json)";

inline constexpr const char* stability_help = R"(Examples:
  ropsim stability                       all cases; exit status 1 when one fails
  ropsim stability --filter 'half.*,peeling.eps-*'
  ropsim stability --out stability       a table, and a page with curves and pictures
  ropsim describe stability              the cases, with what is expected of each)";

inline constexpr const char* capture_help = R"(Examples:
  ropsim capture scene.glb -o scene.rtrace
  ropsim capture scene.glb --camera 0 --size 1280x720 --k 8 -o scene.rtrace --licence 'CC0, Jane Doe')";

inline constexpr const char* record_help = R"(Examples:
  ropsim record -o gears.rtrace -- glxgears
  ropsim record --frames 100:102 -o bunny.rtrace -- glmark2 --size 640x480 -b build:duration=5)";

inline constexpr const char* import_help = R"(Examples:
  ropsim import game.trace -o game.rtrace
  ropsim import game.trace --frames 7:8 --isotropic -o frame.rtrace)";

inline constexpr const char* replay_help = R"(Examples:
  ropsim replay scene.rtrace --out report
  ropsim replay scene.rtrace --gpu g71 --designs existing,scoreboard,blender --set rop.queue=32
  ropsim replay game.rtrace --frames 2:4 --kbuffer blended --k 8    of an application's frames: its blended draws)";

inline constexpr const char* trace_help = R"(Examples:
  ropsim trace info scene.rtrace
  ropsim trace dump scene.rtrace > scene.txt
  ropsim trace validate scene.rtrace        exit status 1 where something is wrong
  ropsim trace diff a.rtrace b.rtrace       exit status 1 where something differs
  ropsim trace cut game.rtrace --frames 7:8 -o frame.rtrace
  ropsim trace cut frame.rtrace --draws 20:30 -o draws.rtrace)";

inline constexpr const char* describe_help = R"(Examples:
  ropsim describe                      an overview
  ropsim describe params               every number of a GPU, with unit, range and meaning
  ropsim describe stats                every counter, with unit and meaning
  ropsim describe scoreboard           one design (GPU, workload, generator, program, parameter, stage)
  ropsim describe --names designs      names only, one a line)";

inline constexpr const char* accuracy_help = R"(Examples:
  ropsim accuracy scene.glb --out accuracy
  ropsim accuracy scene.glb --sweep k=1,2,4 --against 'k=32 program=mlab')";

} // namespace cli
