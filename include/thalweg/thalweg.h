#ifndef THALWEG_THALWEG_H
#define THALWEG_THALWEG_H

/* The C interface: a stable ABI over the main job. C99 and later, C++.
 *
 * A job takes sources (files, arrays) and options, by name and value as on the command line of
 * `thalweg build`, and builds a TIN, which is read back as arrays or written to a file.
 *
 * Functions that can fail return a status; what went wrong is told, for the calling thread, by
 * thalweg_last_message until its next call that fails. No exception leaves a function; where memory runs out
 * the status is THALWEG_OUT_OF_MEMORY, but within the libraries that read options and write reports, which
 * cannot tell and end the process. A NULL object is THALWEG_USAGE. Different objects may be used by different
 * threads at once; one object by one thread at a time, but for thalweg_job_cancel. Strings are UTF-8. Arrays
 * are copied, in and out. */

#include <stddef.h>
#include <stdint.h>

#define THALWEG_API_VERSION 2 /* grows when functions are added; a new soname when one is changed */

#ifdef __cplusplus
extern "C" {
#endif

typedef enum thalweg_status {
  THALWEG_OK = 0,
  THALWEG_USAGE,          /* an option or argument is off */
  THALWEG_NOT_FOUND,      /* a file or layer is missing */
  THALWEG_UNREADABLE,     /* a file exists, but cannot be opened or read */
  THALWEG_BAD_FORMAT,     /* a file's content breaks its format */
  THALWEG_BAD_COORDINATE, /* a coordinate or height is not finite, or out of range */
  THALWEG_EMPTY_INPUT,    /* a source holds nothing usable */
  THALWEG_WRONG_GEOMETRY, /* a layer holds another geometry type than the one needed */
  THALWEG_MISSING_HEIGHT, /* a point has no height and none can be derived */
  THALWEG_TOO_FEW_POINTS, /* fewer than three distinct points */
  THALWEG_COLLINEAR,      /* all points on one line */
  THALWEG_CROSSING_LINES, /* lines cross and the rule says that they must not */
  THALWEG_OUTSIDE_HULL,   /* a vertex without height lies outside of the points' hull */
  THALWEG_TOO_CLOSE,      /* coordinates too close together for double arithmetic */
  THALWEG_BAD_CRS,        /* a CRS is unreadable, or two sources cannot be brought together */
  THALWEG_INVALID_TIN,    /* a mesh breaks a law */
  THALWEG_UNSUPPORTED,    /* known, but not available */
  THALWEG_SIZE_LIMIT,     /* larger than a stated limit */
  THALWEG_OUTPUT_EXISTS,  /* the output is there and overwriting was not asked for */
  THALWEG_WRITE_FAILED,   /* the output could not be written whole */
  THALWEG_OUT_OF_MEMORY,  /* the machine has not enough memory */
  THALWEG_CANCELLED,      /* stopped on request */
  THALWEG_INTERNAL        /* a bug */
} thalweg_status;

/* Kinds of lines; bits, because an edge of a TIN can be several things. */
enum {
  THALWEG_BREAKLINE = 1,
  THALWEG_RIDGE = 2,
  THALWEG_VALLEY = 4,
  THALWEG_BOUNDARY = 8,
  THALWEG_HOLE = 16,
  THALWEG_LAKE = 32
};

typedef struct thalweg_job thalweg_job;
typedef struct thalweg_tin thalweg_tin;

/* Version of the library, "0.1.0"; the THALWEG_API_VERSION that it was built with. */
const char* thalweg_version(void);
int thalweg_api_version(void);

/* The last failure of the calling thread; THALWEG_OK and "" before the first. */
thalweg_status thalweg_last_status(void);
const char* thalweg_last_message(void);
/* Name of a status as the command line prints it: "not-found"; "ok"; "" for numbers that are none. */
const char* thalweg_status_name(thalweg_status status);

/* NULL if there is no memory. Free every job that was made; NULL may be freed. */
thalweg_job* thalweg_job_new(void);
void thalweg_job_free(thalweg_job* job);

/* A file of points, "PATH" or "PATH|layername=NAME". Files of lines and areas are options: "valleys". */
thalweg_status thalweg_job_add_source(thalweg_job* job, const char* source);
/* Points as x, y, z each; x is east or longitude. They come before those of files: vertex i of the TIN is the
 * i-th distinct point that is used. Without the option s-crs they are in the CRS of the job. */
thalweg_status thalweg_job_add_points(thalweg_job* job, const double* xyz, size_t count);
/* One line (of a boundary, hole or lake: one closed ring) of `count` vertices with 2 (soft) or 3 (hard)
 * coordinates each. `kind` is one of the kinds above. */
thalweg_status thalweg_job_add_line(thalweg_job* job, int kind, const double* coordinates, size_t count,
                                    int dimension);
/* An option of `thalweg build` without its dashes: ("max-error", "0.5"). A repeated one adds a value where
 * the command line allows that. Values are checked by thalweg_job_build; unknown names at once. */
thalweg_status thalweg_job_set_option(thalweg_job* job, const char* name, const char* value);
/* Called from the thread that builds, often, with the phase and the fraction done in it; cancels if it
 * returns anything but 0. NULL: no callback. */
typedef int (*thalweg_progress)(const char* phase, double fraction, void* user);
thalweg_status thalweg_job_set_progress(thalweg_job* job, thalweg_progress callback, void* user);
/* Stops the build that runs, or the next one; from any thread. */
void thalweg_job_cancel(thalweg_job* job);
/* Builds; the same job may build again. *tin is set only if THALWEG_OK is returned. */
thalweg_status thalweg_job_build(thalweg_job* job, thalweg_tin** tin);

/* Since version 2. Reads a TIN file and optimises it as `thalweg optimize` does: vertices, heights, outline
 * and constraint edges stay. The job has no points and lines; its options are those of `thalweg optimize`. */
thalweg_status thalweg_job_optimize(thalweg_job* job, const char* path, thalweg_tin** tin);

void thalweg_tin_free(thalweg_tin* tin);
/* Numbers of elements; 0 for NULL. */
size_t thalweg_tin_vertex_count(const thalweg_tin* tin);
size_t thalweg_tin_triangle_count(const thalweg_tin* tin);
size_t thalweg_tin_constraint_count(const thalweg_tin* tin);
/* Copies x, y, z of each vertex, as they would be written to a file. */
thalweg_status thalweg_tin_vertices(const thalweg_tin* tin, double* xyz);
/* Copies the three vertices of each triangle, counter-clockwise, the smallest first, triangles sorted. */
thalweg_status thalweg_tin_triangles(const thalweg_tin* tin, uint32_t* corners);
/* Copies the constrained order of each triangle. */
thalweg_status thalweg_tin_orders(const thalweg_tin* tin, uint16_t* orders);
/* Copies the two vertices of each constraint edge, the smaller first, edges sorted, and its kinds. */
thalweg_status thalweg_tin_constraints(const thalweg_tin* tin, uint32_t* ends, uint8_t* kinds);
/* WKT of the CRS, "" if unknown; the report as JSON. Valid until the TIN is freed; NULL for NULL. */
const char* thalweg_tin_crs(const thalweg_tin* tin);
const char* thalweg_tin_report(const thalweg_tin* tin);
/* Writes a file as `thalweg build` does, the same bytes. `format`: NULL by the extension. `options`: creation
 * options "K=V", ended by NULL, or NULL. `overwrite`: 0 refuses a file that exists. */
thalweg_status thalweg_tin_write(const thalweg_tin* tin, const char* path, const char* format,
                                 const char* const* options, int overwrite);

#ifdef __cplusplus
}
#endif

#endif
