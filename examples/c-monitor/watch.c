/* Reads a drive as CSV, a row a time and vehicle, and prints what two monitors say of it. */

#include "monitor.h"

#include <stdio.h>
#include <string.h>

/* Reads the rows of one time into a sample; returns 0 at the end. */
static int read_sample(double *time, monitor_sample *sample)
{
    char name[16];
    double s, d, v_lon, v_lat, length, width;
    int k;
    for (k = 0; k < 2; ++k) {
        if (scanf("%lf,%15[^,],%lf,%lf,%lf,%lf,%*f,%*f,%lf,%lf%*[^\n]", time, name, &s, &d, &v_lon, &v_lat,
                  &length, &width) != 8) {
            return 0;
        }
        if (strcmp(name, "SV") == 0) {
            sample->s_SV = s;
            sample->d_SV = d;
            sample->v_lon_SV = v_lon;
            sample->v_lat_SV = v_lat;
            sample->length_SV = length;
            sample->width_SV = width;
        } else {
            sample->s_POV = s;
            sample->d_POV = d;
            sample->v_lon_POV = v_lon;
            sample->v_lat_POV = v_lat;
            sample->length_POV = length;
            sample->width_POV = width;
        }
    }
    return 1;
}

int main(void)
{
    static const char *const words[] = { "FALSE", "UNKNOWN", "TRUE" };
    const double step = 1.0 / 25.0;
    double time = 0.0;
    monitor_sample sample;
    monitor_verdict scenario = MONITOR_UNKNOWN, danger = MONITOR_UNKNOWN, last;
    scenario_4_state on_scenario;
    danger_SV_POV_state on_danger;
    scenario_4_reset(&on_scenario);
    danger_SV_POV_reset(&on_danger);
    if (scanf("%*[^\n]") == EOF) { /* the names of the columns */
        return 1;
    }
    while (read_sample(&time, &sample)) {
        const monitor_verdict first = scenario_4_step(&on_scenario, &sample);
        const monitor_verdict each = danger_SV_POV_step(&on_danger, &sample);
        if (each != danger) {
            printf("at %.2f s: danger at %.2f s is %s\n", time, time - DANGER_SV_POV_DELAY * step, words[each]);
        }
        if (first != scenario) {
            printf("at %.2f s: scenario 4 is %s\n", time, words[first]);
        }
        scenario = first;
        danger = each;
    }
    scenario_4_finish(&on_scenario, &last);
    printf("at the end: scenario 4 is %s\n", words[last]);
    return 0;
}
