/* The C interface as a C program uses it: builds from arrays, reads back, fails in known ways, cancels, and
 * builds on several threads at once. Usage: test_capi FOLDER */
#include <thalweg/thalweg.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <threads.h>

static int failures = 0;

#define EXPECT(condition)                                                                         \
  do {                                                                                            \
    if (!(condition)) {                                                                           \
      fprintf(stderr, "%s:%d: not true: %s (last message: %s)\n", __FILE__, __LINE__, #condition, \
              thalweg_last_message());                                                            \
      ++failures;                                                                                 \
    }                                                                                             \
  } while (0)

enum { SIDE = 30, COUNT = SIDE * SIDE };

static void fill_lattice(double* xyz) {
  for (int i = 0; i < COUNT; ++i) {
    const int x = i % SIDE, y = i / SIDE;
    xyz[3 * i] = 500000 + 10.0 * x;
    xyz[3 * i + 1] = 5200000 + 10.0 * y;
    xyz[3 * i + 2] = (x * 7 + y * 5) % 11 + 0.25 * y;
  }
}

static thalweg_job* lattice_job(void) {
  double* copy = malloc(3 * COUNT * sizeof(double));
  fill_lattice(copy);
  thalweg_job* job = thalweg_job_new();
  EXPECT(job != NULL);
  EXPECT(thalweg_job_add_points(job, copy, COUNT) == THALWEG_OK);
  free(copy); /* arrays are copied */
  return job;
}

/* One by one they cost no more than all at once. */
static void test_single_points(void) {
  thalweg_job* job = thalweg_job_new();
  for (int i = 0; i < 200000; ++i) {
    const double xyz[] = {i % 450, i / 450, i % 7};
    EXPECT(thalweg_job_add_points(job, xyz, 1) == THALWEG_OK);
  }
  thalweg_job_free(job);
}

static void test_versions(void) {
  EXPECT(strcmp(thalweg_version(), "") != 0);
  EXPECT(thalweg_api_version() == THALWEG_API_VERSION);
  EXPECT(strcmp(thalweg_status_name(THALWEG_OK), "ok") == 0);
  EXPECT(strcmp(thalweg_status_name(THALWEG_USAGE), "usage") == 0);
  EXPECT(strcmp(thalweg_status_name(THALWEG_CANCELLED), "cancelled") == 0);
  EXPECT(strcmp(thalweg_status_name(THALWEG_INTERNAL), "internal") == 0);
  EXPECT(strcmp(thalweg_status_name((thalweg_status)99), "") == 0);
  EXPECT(thalweg_last_status() == THALWEG_OK && strcmp(thalweg_last_message(), "") == 0);
}

static void test_build_and_read_back(const char* folder) {
  thalweg_job* job = lattice_job();
  const double valley[] = {500000, 5200000, 1, 500290, 5200290, 0};
  const double soft[] = {500290, 5200000, 500000, 5200290};
  EXPECT(thalweg_job_add_line(job, THALWEG_VALLEY, valley, 2, 3) == THALWEG_OK);
  EXPECT(thalweg_job_add_line(job, THALWEG_RIDGE, soft, 2, 2) == THALWEG_OK);
  EXPECT(thalweg_job_set_option(job, "a-crs", "EPSG:32632") == THALWEG_OK);
  EXPECT(thalweg_job_set_option(job, "optimize", "local-minima,normal-angle-sum") == THALWEG_OK);
  EXPECT(thalweg_job_set_option(job, "threads", "1") == THALWEG_OK);
  thalweg_tin* tin = NULL;
  EXPECT(thalweg_job_build(job, &tin) == THALWEG_OK);
  const size_t vertices = thalweg_tin_vertex_count(tin), triangles = thalweg_tin_triangle_count(tin);
  const size_t constraints = thalweg_tin_constraint_count(tin);
  EXPECT(vertices >= COUNT);
  EXPECT(constraints == 2 * (SIDE - 1) + (vertices > COUNT ? 2 : 0));
  double* xyz = malloc(3 * vertices * sizeof(double));
  double* given = malloc(3 * COUNT * sizeof(double));
  uint32_t* corners = malloc(3 * triangles * sizeof(uint32_t));
  uint16_t* orders = malloc(triangles * sizeof(uint16_t));
  uint32_t* ends = malloc(2 * constraints * sizeof(uint32_t));
  uint8_t* kinds = malloc(constraints);
  EXPECT(thalweg_tin_vertices(tin, xyz) == THALWEG_OK);
  EXPECT(thalweg_tin_triangles(tin, corners) == THALWEG_OK);
  EXPECT(thalweg_tin_orders(tin, orders) == THALWEG_OK);
  EXPECT(thalweg_tin_constraints(tin, ends, kinds) == THALWEG_OK);
  fill_lattice(given);
  for (int i = 0; i < COUNT; ++i) { /* ids are those of the array */
    EXPECT(xyz[3 * i] == given[3 * i] && xyz[3 * i + 1] == given[3 * i + 1]);
  }
  double area = 0;
  int new_orders = 0;
  for (size_t t = 0; t < triangles; ++t) {
    const double* a = xyz + 3 * corners[3 * t];
    const double* b = xyz + 3 * corners[3 * t + 1];
    const double* c = xyz + 3 * corners[3 * t + 2];
    area += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
    EXPECT(orders[t] <= 1);
    new_orders += orders[t];
  }
  EXPECT(area == 290.0 * 290.0);
  EXPECT(new_orders > 0);
  for (size_t e = 0; e < constraints; ++e) {
    EXPECT(ends[2 * e] < ends[2 * e + 1]);
    EXPECT(kinds[e] == THALWEG_VALLEY || kinds[e] == THALWEG_RIDGE);
  }
  EXPECT(strstr(thalweg_tin_crs(tin), "32632") != NULL);
  EXPECT(strstr(thalweg_tin_report(tin), "\"criteria\"") != NULL);
  EXPECT(strstr(thalweg_tin_report(tin), "lines in memory") != NULL); /* the valley's conflicts with points */

  char path[4096];
  snprintf(path, sizeof path, "%s/c_interface.ply", folder);
  remove(path);
  const char* options[] = {"EDGES=NO", NULL};
  EXPECT(thalweg_tin_write(tin, path, NULL, options, 0) == THALWEG_OK);
  EXPECT(thalweg_tin_write(tin, path, "PLY", NULL, 0) == THALWEG_OUTPUT_EXISTS);
  EXPECT(thalweg_last_status() == THALWEG_OUTPUT_EXISTS && strstr(thalweg_last_message(), path) != NULL);
  EXPECT(thalweg_tin_write(tin, path, "PLY", NULL, 1) == THALWEG_OK);
  EXPECT(thalweg_tin_write(tin, "no-such-folder/x.ply", NULL, NULL, 0) == THALWEG_NOT_FOUND);
  EXPECT(thalweg_tin_write(tin, path, "no-such-format", NULL, 1) == THALWEG_USAGE);
  thalweg_tin_free(tin);
  thalweg_job_free(job);
  free(xyz);
  free(given);
  free(corners);
  free(orders);
  free(ends);
  free(kinds);
}

static void test_failures(void) {
  thalweg_tin* tin = NULL;
  EXPECT(thalweg_job_build(NULL, &tin) == THALWEG_USAGE);
  EXPECT(strstr(thalweg_last_message(), "NULL") != NULL);
  EXPECT(thalweg_tin_vertices(NULL, NULL) == THALWEG_USAGE);
  EXPECT(thalweg_tin_vertex_count(NULL) == 0 && thalweg_tin_report(NULL) == NULL);
  thalweg_tin_free(NULL);
  thalweg_job_free(NULL);
  thalweg_job_cancel(NULL);

  thalweg_job* job = thalweg_job_new();
  EXPECT(thalweg_job_build(job, NULL) == THALWEG_USAGE);
  EXPECT(thalweg_job_set_option(job, "no-such-option", "1") == THALWEG_USAGE);
  EXPECT(strstr(thalweg_last_message(), "no-such-option") != NULL);
  EXPECT(thalweg_job_set_option(job, "overwrite", "1") ==
         THALWEG_USAGE); /* where it goes is no option here */
  EXPECT(thalweg_job_set_option(job, "max-error", NULL) == THALWEG_USAGE);
  EXPECT(thalweg_job_add_points(job, NULL, 3) == THALWEG_USAGE);
  const double one[] = {0, 0, 1};
  EXPECT(thalweg_job_add_points(job, one, SIZE_MAX) == THALWEG_SIZE_LIMIT);
  EXPECT(thalweg_job_add_source(job, "x.gpkg|layername=") == THALWEG_USAGE);
  const double two[] = {0, 0, 1, 1, 1, 1};
  EXPECT(thalweg_job_add_line(job, 3, two, 2, 3) == THALWEG_USAGE);
  EXPECT(thalweg_job_add_line(job, THALWEG_RIDGE, two, 2, 4) == THALWEG_USAGE);
  EXPECT(thalweg_job_add_points(job, two, 2) == THALWEG_OK);
  EXPECT(thalweg_job_build(job, &tin) == THALWEG_TOO_FEW_POINTS && tin == NULL);
  const double third[] = {2, 2, 2};
  EXPECT(thalweg_job_add_points(job, third, 1) == THALWEG_OK);
  EXPECT(thalweg_job_build(job, &tin) == THALWEG_COLLINEAR);
  const double aside[] = {0, 3, 1};
  EXPECT(thalweg_job_add_points(job, aside, 1) == THALWEG_OK);
  EXPECT(thalweg_job_build(job, &tin) == THALWEG_OK && thalweg_tin_triangle_count(tin) == 2);
  thalweg_tin_free(tin);
  tin = NULL;
  EXPECT(thalweg_job_set_option(job, "max-error", "-1") == THALWEG_OK);
  EXPECT(thalweg_job_build(job, &tin) == THALWEG_USAGE &&
         strstr(thalweg_last_message(), "max-error") != NULL);
  thalweg_job_free(job);

  job = thalweg_job_new();
  EXPECT(thalweg_job_add_source(job, "no-such-file.csv") == THALWEG_OK);
  EXPECT(thalweg_job_build(job, &tin) == THALWEG_NOT_FOUND);
  EXPECT(strstr(thalweg_last_message(), "no-such-file.csv") != NULL);
  thalweg_job_free(job);

  job = lattice_job();
  const double zero = 0;
  const double bad[] = {1, 2, 0 / zero};
  EXPECT(thalweg_job_add_points(job, bad, 1) == THALWEG_OK);
  EXPECT(thalweg_job_build(job, &tin) == THALWEG_BAD_COORDINATE);
  EXPECT(strstr(thalweg_last_message(), "point 900") != NULL);
  thalweg_job_free(job);
}

/* Corners of all triangles, to be freed. */
static uint32_t* triangles_of(const thalweg_tin* tin) {
  uint32_t* corners = malloc(3 * thalweg_tin_triangle_count(tin) * sizeof(uint32_t));
  EXPECT(thalweg_tin_triangles(tin, corners) == THALWEG_OK);
  return corners;
}

static double length_of_edges(const thalweg_tin* tin) {
  const char* found = strstr(thalweg_tin_report(tin), "\"name\": \"edge-length\"");
  found = found == NULL ? NULL : strstr(found, "\"result\": ");
  EXPECT(found != NULL);
  return found == NULL ? 0 : strtod(found + strlen("\"result\": "), NULL);
}

static void test_optimize(const char* folder) {
  char path[4096];
  snprintf(path, sizeof path, "%s/c_optimize.ply", folder);
  const double valley[] = {500000, 5200000, 1, 500290, 5200290, 0};
  thalweg_job* job = lattice_job();
  thalweg_tin* given = NULL;
  thalweg_tin* tin = NULL;
  EXPECT(thalweg_job_add_line(job, THALWEG_VALLEY, valley, 2, 3) == THALWEG_OK);
  EXPECT(thalweg_job_set_option(job, "optimize", "none") == THALWEG_OK);
  EXPECT(thalweg_job_build(job, &given) == THALWEG_OK);
  EXPECT(thalweg_tin_write(given, path, NULL, NULL, 1) == THALWEG_OK);
  EXPECT(thalweg_job_optimize(job, path, &tin) == THALWEG_USAGE &&
         tin == NULL); /* it has points of its own */
  thalweg_job_free(job);

  job = thalweg_job_new();
  EXPECT(thalweg_job_set_option(job, "optimize", "edge-length") == THALWEG_OK);
  EXPECT(thalweg_job_optimize(job, path, &tin) == THALWEG_OK);
  const size_t vertices = thalweg_tin_vertex_count(tin), triangles = thalweg_tin_triangle_count(tin);
  const size_t constraints = thalweg_tin_constraint_count(tin);
  EXPECT(vertices == thalweg_tin_vertex_count(given) && triangles == thalweg_tin_triangle_count(given));
  EXPECT(constraints == thalweg_tin_constraint_count(given) && constraints > 0);
  double* before = malloc(3 * vertices * sizeof(double));
  double* after = malloc(3 * vertices * sizeof(double));
  EXPECT(thalweg_tin_vertices(given, before) == THALWEG_OK && thalweg_tin_vertices(tin, after) == THALWEG_OK);
  EXPECT(memcmp(before, after, 3 * vertices * sizeof(double)) == 0);
  uint32_t* ends = malloc(2 * constraints * sizeof(uint32_t));
  uint8_t* kinds = malloc(constraints);
  EXPECT(thalweg_tin_constraints(tin, ends, kinds) == THALWEG_OK);
  for (size_t e = 0; e < constraints; ++e) EXPECT(kinds[e] == THALWEG_VALLEY);

  /* Fewest pits is another aim, gives other triangles, and edges that are no shorter. */
  EXPECT(thalweg_job_set_option(job, "definition", "pathcon") == THALWEG_OK);
  EXPECT(thalweg_job_set_option(job, "max-error", "1") == THALWEG_OK); /* an option of build ... */
  thalweg_tin* none = NULL;
  EXPECT(thalweg_job_optimize(job, path, &none) == THALWEG_USAGE && none == NULL); /* ... that does not fit */
  thalweg_job_free(job);
  job = thalweg_job_new();
  EXPECT(thalweg_job_set_option(job, "optimize", "local-minima,edge-length") == THALWEG_OK);
  thalweg_tin* drained = NULL;
  EXPECT(thalweg_job_optimize(job, path, &drained) == THALWEG_OK);
  uint32_t* shortest = triangles_of(tin);
  uint32_t* driest = triangles_of(drained);
  EXPECT(memcmp(shortest, driest, 3 * triangles * sizeof(uint32_t)) != 0);
  EXPECT(length_of_edges(tin) > 0 && length_of_edges(tin) <= length_of_edges(drained));

  /* The options of the command, conditioning among them. */
  thalweg_job* fill = thalweg_job_new();
  thalweg_tin* filled = NULL;
  EXPECT(thalweg_job_set_option(fill, "condition", "fill") == THALWEG_OK);
  EXPECT(thalweg_job_optimize(fill, path, &filled) == THALWEG_OK);
  EXPECT(strstr(thalweg_tin_report(filled), "\"conditioned\"") != NULL);
  thalweg_tin_free(filled);
  thalweg_job_free(fill);

  EXPECT(thalweg_job_optimize(job, NULL, &none) == THALWEG_USAGE && none == NULL);
  EXPECT(thalweg_job_optimize(job, path, NULL) == THALWEG_USAGE);
  EXPECT(thalweg_job_optimize(NULL, path, &none) == THALWEG_USAGE);
  EXPECT(thalweg_job_optimize(job, "no-such.ply", &none) == THALWEG_NOT_FOUND && none == NULL);
  EXPECT(thalweg_job_optimize(job, folder, &none) != THALWEG_OK && none == NULL);
  thalweg_job_cancel(job);
  EXPECT(thalweg_job_optimize(job, path, &none) == THALWEG_CANCELLED && none == NULL);
  remove(path);
  free(before);
  free(after);
  free(ends);
  free(kinds);
  free(shortest);
  free(driest);
  thalweg_tin_free(given);
  thalweg_tin_free(tin);
  thalweg_tin_free(drained);
  thalweg_job_free(job);
}

typedef struct {
  int calls;
  const char* cancel_in;
  int cancel_at; /* this call; 0: none */
} watcher;

static int watch(const char* phase, double fraction, void* user) {
  watcher* w = user;
  ++w->calls;
  EXPECT(fraction >= 0 && fraction <= 1);
  if (w->calls == w->cancel_at) return 1;
  return w->cancel_in != NULL && strcmp(phase, w->cancel_in) == 0;
}

static void test_progress_and_cancel(void) {
  thalweg_job* job = lattice_job();
  thalweg_tin* tin = NULL;
  watcher w = {0, "optimize", 0};
  EXPECT(thalweg_job_set_progress(job, watch, &w) == THALWEG_OK);
  EXPECT(thalweg_job_build(job, &tin) == THALWEG_CANCELLED && tin == NULL);
  EXPECT(w.calls > 3);
  w.cancel_in = NULL;
  w.calls = 0;
  EXPECT(thalweg_job_build(job, &tin) == THALWEG_OK); /* a wish to stop is for one build */
  thalweg_tin_free(tin);
  tin = NULL;
  w.cancel_at = w.calls; /* the last word counts */
  w.calls = 0;
  EXPECT(thalweg_job_build(job, &tin) == THALWEG_CANCELLED && tin == NULL);
  EXPECT(w.calls == w.cancel_at);
  w.cancel_at = 0;
  thalweg_job_cancel(job);
  EXPECT(thalweg_job_build(job, &tin) == THALWEG_CANCELLED);
  EXPECT(thalweg_job_set_progress(job, NULL, NULL) == THALWEG_OK);
  EXPECT(thalweg_job_build(job, &tin) == THALWEG_OK);
  thalweg_tin_free(tin);
  thalweg_job_free(job);
}

static int build_on_thread(void* user) {
  char** report = user;
  thalweg_job* job = lattice_job();
  thalweg_tin* tin = NULL;
  thalweg_tin_vertices(NULL, NULL); /* this thread's failure is not the others' */
  int bad = thalweg_last_status() != THALWEG_USAGE || thalweg_job_build(job, &tin) != THALWEG_OK;
  if (!bad) {
    const char* digest = strstr(thalweg_tin_report(tin), "\"digest\"");
    *report = malloc(100);
    snprintf(*report, 100, "%.90s", digest);
  }
  thalweg_tin_free(tin);
  thalweg_job_free(job);
  return bad;
}

static void test_threads(void) {
  enum { THREADS = 4 };
  thrd_t threads[THREADS];
  char* reports[THREADS] = {NULL};
  const thalweg_status before = thalweg_last_status();
  for (int i = 0; i < THREADS; ++i)
    EXPECT(thrd_create(&threads[i], build_on_thread, &reports[i]) == thrd_success);
  for (int i = 0; i < THREADS; ++i) {
    int bad = 1;
    EXPECT(thrd_join(threads[i], &bad) == thrd_success && bad == 0);
  }
  EXPECT(thalweg_last_status() == before);
  for (int i = 0; i < THREADS; ++i) {
    EXPECT(reports[i] != NULL && strcmp(reports[i], reports[0]) == 0);
  }
  for (int i = 0; i < THREADS; ++i) free(reports[i]);
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  test_versions();
  test_single_points();
  test_build_and_read_back(argv[1]);
  test_failures();
  test_optimize(argv[1]);
  test_progress_and_cancel();
  test_threads();
  if (failures == 0) printf("all as expected\n");
  return failures == 0 ? 0 : 1;
}
