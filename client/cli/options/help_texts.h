// SPDX-License-Identifier: Apache-2.0
// What --help says below the options.
#ifndef FLATLIGHT_CLIENT_CLI_OPTIONS_HELP_TEXTS_H_
#define FLATLIGHT_CLIENT_CLI_OPTIONS_HELP_TEXTS_H_

namespace flatlight {

inline constexpr char kMainHelp[] = R"(Examples:
  flatlight scenes                                          what there is to start with
  flatlight render gallery:penumbra -o out.json -o out.svg  render, write the result and a plot
  flatlight explain scene.json --method path-tracing        what would be done, and why
  flatlight submit scene.json --server farm:7000            leave the work to a server
  flatlight compare mine.json reference.json                are they equal within their errors?
  flatlight figure derivatives-occluded -o figure.svg       an experiment of the papers, repeated
  flatlight bench gallery:penumbra -o bench.svg             run time against error of every method

Environment:
  FLATLIGHT_SERVER  the server, if there is no --server: HOST:PORT or unix:PATH
  FLATLIGHT_TOKEN   the token that the server asks for
  FLATLIGHT_TLS_CA, _CERT, _KEY, _NAME  as --tls-ca and so on. Any of them turns TLS on; with other machines it always is.
Without a server, render, scenes, explain, validate, figure and bench start one of their own for as long as they run.

Exit status:
  0 done   1 the job failed   2 bad usage or bad scene   3 server not reached   4 denied or over quota
  5 an output could not be written   10 compare found a difference, or bench compare something worse   130 interrupted)";

inline constexpr char kRenderHelp[] = R"(The ending of OUT picks its form:
  .json        the whole result (RenderResult of the API); - writes it to standard output
  .csv         a row a point: probe, index, x, y, nx, ny, arcLength, irradiance, standardError, gradient, gradientError,
               hessian, hessianError, samples; only what there is. In colour irradianceR, irradianceG, irradianceB, ...
  .npy         the same for numpy.load: a structured array, an element a point; probe is the probe's number,
               spectral fields have shape (3,) in colour
  .svg .png    a plot: irradiance over arc length with a band of two standard errors, derivatives below (needs gnuplot)
  .exr .hdr    pictures of irradiance, a pixel a point; .exr has a part for each probe, .hdr a row
Files are written under a temporary name and then renamed, so they are there whole or not at all.
Ctrl-C cancels the job, and so does a reader of standard output that goes away (`| head`).
A job goes on when the connection breaks, and is found again; with --cancel-on-disconnect the server cancels it then.

Examples:
  flatlight render scene.json --samples 4096 -o result.json -o plot.png
  flatlight render gallery:unit-light --method exact --derivatives hessian -o - | jq .probes[0].irradiance
  flatlight render - --target-error 0.01 --time-limit 60 -o result.csv < scene.json)";

inline constexpr char kSubmitHelp[] = R"(Prints the name of the job, and returns at once.

Example:
  job=$(flatlight submit scene.json --samples 100000 --quiet)
  flatlight watch $job && flatlight fetch $job -o result.json)";

inline constexpr char kWatchHelp[] =
    R"(Waits until the job has ended, and takes up a broken connection again by itself. Ctrl-C stops watching; the job goes on,
unless --cancel-on-disconnect says that the server shall cancel it when it loses this watch, however that comes about.
With --records the log of irradiance caching's records goes to standard output, from its beginning and each record once,
and all else to standard error. The radii of records become smaller as others join them: the result has the last ones.
JOB is jobs/UUID, a UUID, or the beginning of one.)";

inline constexpr char kJobHelp[] = R"(JOB is jobs/UUID, a UUID, or the beginning of one.)";

inline constexpr char kTopHelp[] =
    R"(On a terminal it stays, and shows the state of every second; Ctrl-C ends it. Elsewhere it shows one state.)";

inline constexpr char kQuotaHelp[] =
    R"(What is over a limit is refused, with exit status 4 and when to try again. Jobs of who has used up the processor time of a
day rest, and go on by themselves at 00:00 UTC.)";

inline constexpr char kSecretHelp[] =
    R"(The same secret for all of your jobs, until you rotate it. Receivers check with it the header webhook-signature, as the
Standard Webhooks specification has it. After --rotate that header has a signature with each secret, so that receivers can
be given the new one at leisure; standard error says for how long.)";

inline constexpr char kHealthHelp[] =
    R"(For health checks of containers and the like: exit status 0 if the server says that it serves, 3 if it says that it does
not, as while it is ending, or says nothing for 3 s.)";

inline constexpr char kFetchHelp[] =
    R"(JOB is jobs/UUID, a UUID, or the beginning of one. It must have ended; of a cancelled one there is what was done.
See `flatlight render --help` for the forms of OUT.)";

inline constexpr char kScenesHelp[] = R"(Examples:
  flatlight scenes
  flatlight scenes penumbra > mine.json    a copy to change
  flatlight scenes --mine
  flatlight scenes 90c1 --delete)";

inline constexpr char kExplainHelp[] = R"(Renders nothing. Names in the list of skips are for --no-skip.)";

inline constexpr char kFigureHelp[] = R"(Figures:
  derivatives           gradient and Hessian below a light, exact and in all formulations; nothing blocks
  derivatives-occluded  the same behind a plate, where arc-length fails (Jarosz et al. 2012)
  convergence           error of every method against run time, with fitted slopes; -o as in `flatlight bench`
  extrapolation         what gradient and Hessian of two records tell of the irradiance around them
  records-walls         where records go beside a white wall, a black one and none: mean distance against Hessian
  records-errors        error against number of records, for every error control and degree of extrapolation (.csv .svg .png)

Examples:
  flatlight figure derivatives-occluded -o figure.svg -o figure.csv
  flatlight figure convergence -o convergence.svg)";

inline constexpr char kShareHelp[] =
    R"(WHAT is jobs/UUID, the UUID, or the beginning of one that only one of the server's jobs has; or scenes/HASH of a scene
that you have uploaded, or the beginning of that. With whom it is shared, and what they may do, is printed.
`flatlight jobs --shared` and `flatlight scenes --shared` list what others share with you.

Examples:
  flatlight share 3f2a --with user:ada
  flatlight share 3f2a --with group:lab-1 --with user:bob --control
  flatlight unshare 3f2a --with group:lab-1
  flatlight share scenes/90c1 --with course)";

inline constexpr char kRoomHelp[] =
    R"(As long as a room is open and looks at a job, all who are in the room may see, watch and fetch that job.

Examples:
  flatlight room create "Lab 3: penumbras"
  flatlight room share 3f2a --with group:lab-3
  flatlight room look 3f2a --job 81c0 --probe floor --point 120 --exposure 1.5
  flatlight room watch 3f2a
  flatlight room note 3f2a "here the lamp is hidden in part" --at 0.5,0)";

inline constexpr char kCompareHelp[] =
    R"(A and B are results in JSON form with the same probes at the same points; B is the reference. Printed for irradiance and, if
both have them, derivatives of each probe:
  rms, max    of the difference A - B          relative rms    rms over the rms of B
  z           difference / its standard error: mean z (0 without bias), mean z^2 (1 if the errors are honest)

Verdict (exit status 0: equal, 10: they differ, 2: not comparable):
  with --tolerance X   at every point |A - B| <= X * max(|B|, 1 % of the probe's mean |B|)
  without              by the errors that the results state. At every point |A - B| must not exceed t * standard error +
                       stated bounds + rounding; over each probe mean z and mean z^2 must agree with 0 and 1. t is
                       Student's for 14 degrees of freedom such that equal results fail less than once in 10 000 times,
                       whatever the number of points.
Points that a time limit left without samples, in A or in B, are left out.

Examples:
  flatlight compare result.json reference.json
  flatlight compare a.json b.json --tolerance 0.01 --json)";

inline constexpr char kBenchHelp[] =
    R"(Renders scenes with methods and budgets (samples), one job at a time, and measures every result against the truth: exact
light where there is no reflection, the reference of all bounces where lambertian curves reflect. Other scenes are
benched with --max-bounces 0, unless there is a truth for all their bounces: --truth, a stored result of the same scene,
or --truth-samples, whose own error is taken out of the errors and shown. Every method is warmed up once; then rounds go through all methods and budgets, each with another
seed, so that a machine that gets slower does so for all. Times are the server's own; processor time is what counts.

The ending of OUT picks its form:
  .csv         a row a run, written as it ends. The same command with the same file does only what is missing; Ctrl-C
               loses nothing. A file of another machine, build or other settings is refused; with --force its rows stay,
               and count for nothing.
  .svg .png    error against time, both logarithmic, with the fitted line of each method (needs gnuplot)
  .json        the report; - writes it to standard output

Examples:
  flatlight bench gallery:penumbra gallery:ring -o bench.csv -o bench.svg
  flatlight bench --gallery --methods path-tracing --budgets 64,256,1024 --time-limit 120
  flatlight bench gallery:cornell --truth-samples 1000000
  flatlight bench compare before.csv after.csv)";

inline constexpr char kBenchCompareHelp[] =
    R"(A and B are CSV files of `flatlight bench`. Points of the same scene, method, settings, truth and budget are compared: the
ratio B over A of processor time, of RMS error and of efficiency (1 / (error^2 * time)), with an interval by Student's t
on logarithms: of the errors of the seeds (seed by seed, if both have the same), and of the least time of every few runs
that follow each other (2 of 8, 4 of 32), since other work on a machine makes runs slower, never faster.

Verdict of a point, and of all together (exit status 0, or 10: something is worse):
  better, worse        the interval leaves 1 out, and the change is one that counts (--least). Efficiency goes first:
                       less time for more error may be worth it. The intervals are so wide that of two benchmarks of the
                       same less than 1 in 100 shows any point better or worse, whatever the number of points.
  no difference seen   the interval is no wider than 4 * --least to either side
  too noisy to tell    it is; so many runs (--seeds, --repeats) would do

The runs know the noise within each benchmark, not what changed on the machine from one to the other. For small changes
take turns: bench A with --seeds 4, bench B with --seeds 4, then both again with --seeds 8, each with its own file.
Times of different machines are not compared, errors are.

Example:
  flatlight bench compare before.csv after.csv --least 0.1)";

}  // namespace flatlight

#endif  // FLATLIGHT_CLIENT_CLI_OPTIONS_HELP_TEXTS_H_
