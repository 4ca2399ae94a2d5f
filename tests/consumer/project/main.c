/* Uses the installed C interface: a TIN of five points. */
#include <thalweg/thalweg.h>

#include <stdio.h>

int main(void) {
  const double xyz[] = {0, 0, 1, 10, 0, 2, 10, 10, 3, 0, 10, 4, 5, 4, 0};
  thalweg_job* job = thalweg_job_new();
  thalweg_tin* tin = NULL;
  if (thalweg_job_add_points(job, xyz, 5) != THALWEG_OK || thalweg_job_build(job, &tin) != THALWEG_OK) {
    fprintf(stderr, "%s\n", thalweg_last_message());
    return 1;
  }
  const size_t triangles = thalweg_tin_triangle_count(tin);
  printf("thalweg %s: %zu triangles\n", thalweg_version(), triangles);
  thalweg_tin_free(tin);
  thalweg_job_free(job);
  return triangles == 4 ? 0 : 1;
}
