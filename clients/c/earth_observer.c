/* The exported control system of scenarios/earth-observer.toml as the flight software of a run in lockstep:
 *
 *     flexsc export-c scenarios/earth-observer.toml -o flight --name aocs
 *     make -C clients/c earth_observer FLIGHT=../../flight
 *     flexsc serve scenarios/earth-observer.toml --period 0.05
 *     clients/c/earth_observer
 *
 * Sensors in, torques out: attitude filter and law are those of the export, started as in run 0. The rows of the log are those of
 * `flexsc simulate` to the last bit. Arguments: host, port, and `tcp` for a server with `--tcp`. */
#include "aocs.h"
#include "flexsc_lockstep.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Period of the law: a quarter of a second, in femtoseconds. */
#define LAW_PERIOD INT64_C(250000000000000)

static flexsc_client client;
static aocs_state state;

/* Gives the filter the readings that have come since the last cycle. */
static void sample(aocs_ticks now)
{
    aocs_sample_input input = {.gyro_is_valid = flexsc_is_new(&client, "gyro"), .star_tracker_is_valid = flexsc_is_new(&client, "star_tracker")};
    aocs_sample_output output;
    if (!input.gyro_is_valid && !input.star_tracker_is_valid) {
        return;
    }
    flexsc_read(&client, "gyro.rate", input.gyro_rate, 3);
    flexsc_read(&client, "star_tracker.attitude", input.star_tracker_attitude, 4);
    aocs_sample(&state, now, &input, &output);
}

/* Decides, and sends the torques. */
static int step(aocs_ticks now)
{
    aocs_step_input input;
    aocs_step_output output;
    flexsc_read(&client, "reference.attitude", input.target_attitude, 4);
    flexsc_read(&client, "reference.angle", input.reference_angle, 3);
    flexsc_read(&client, "reference.rate", input.reference_rate, 3);
    flexsc_read(&client, "reference.acceleration", input.reference_acceleration, 3);
    flexsc_read(&client, "wheels.speed", input.wheel_speed, 4);
    aocs_step(&state, now, &input, &output);
    return flexsc_command(&client, output.torque, FLEXSC_TORQUE);
}

int main(int count, char **arguments)
{
    const char *host = count > 1 ? arguments[1] : "127.0.0.1";
    const uint16_t port = (uint16_t)(count > 2 ? strtoul(arguments[2], NULL, 10) : 5010);
    const int transport = count > 3 && strcmp(arguments[3], "tcp") == 0 ? FLEXSC_TCP : FLEXSC_UDP;
    if (flexsc_connect(&client, transport, host, port, 0) != 0) {
        fprintf(stderr, "error: %s\n", client.error);
        return 1;
    }
    aocs_init(&state);
    int status;
    while ((status = flexsc_receive(&client)) == 1) {
        const aocs_ticks now = {.whole = client.time_s, .part = client.time_fs};
        if (client.cycle == 0) {
            aocs_start_output output;
            aocs_start(&state, now, &aocs_run_start, &output);
        }
        sample(now);
        if ((now.part % LAW_PERIOD == 0 ? step(now) : flexsc_hold(&client)) != 0) {
            status = -1;
            break;
        }
    }
    if (status < 0) {
        fprintf(stderr, "error: %s\n", client.error);
    } else {
        printf("%llu cycles, %s\n", (unsigned long long)client.cycle + 1, client.end == FLEXSC_COMPLETE ? "complete" : "not complete");
    }
    flexsc_close(&client);
    return status < 0 || client.end == FLEXSC_FAILED;
}
