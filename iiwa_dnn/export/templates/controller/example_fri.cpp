// A client of KUKA's Fast Robot Interface that moves the arm by the controller, in position control.
// It needs KUKA's FRI client SDK, in the folder SDK with its library built:
//     cc -O2 -c controller.c
//     c++ -O2 -I$SDK/include example_fri.cpp controller.o libFRIClient.a -o example_fri
#include <cmath>
#include <cstddef>  // the SDK's headers take NULL for granted

#include "controller.h"
#include "friClientApplication.h"
#include "friLBRClient.h"
#include "friUdpConnection.h"

static_assert(CONTROLLER_DOF == KUKA::FRI::LBRState::NUMBER_OF_JOINTS, "an LBR arm has 7 joints");

class ControllerClient : public KUKA::FRI::LBRClient {
public:
    ControllerClient() { controller_init(&controller_); }

    // Called by the FRI at every sample while the robot may be commanded.
    void command() override
    {
        if (!started_) {
            // Where the robot is commanded to be: the measured position would be a small jump.
            const double *held = robotState().getIpoJointPosition();
            for (int i = 0; i < CONTROLLER_DOF; i++) {
                q_[i] = held[i];
            }
            started_ = true;
        }
        if (std::fabs(robotState().getSampleTime() - CONTROLLER_DT) > 1e-9) {
            last_action = CONTROLLER_INVALID;  // another sample time is another speed
            robotCommand().setJointPosition(q_);
            return;
        }
        double dq[CONTROLLER_DOF];
@fri_sample@        last_action = controller_step(&controller_, q_, target, dq);
        for (int i = 0; i < CONTROLLER_DOF; i++) {
            q_[i] += CONTROLLER_DT * dq[i];  // what was commanded, free of the encoders' noise
        }
        robotCommand().setJointPosition(q_);
        t_ += CONTROLLER_DT;
    }

    double target[18 * CONTROLLER_FRAMES] = {@target@};  // see README.md
    int last_action = 0;

private:
    struct controller controller_;
    double q_[CONTROLLER_DOF] = {0.0};
    double t_ = 0.0;
    bool started_ = false;
};

int main()
{
    ControllerClient client;
    KUKA::FRI::UdpConnection connection;
    KUKA::FRI::ClientApplication application(connection, client);
    if (!application.connect(30200, nullptr)) {  // whichever robot sends to this port
        return 1;
    }
    while (application.step() && client.robotState().getSessionState() != KUKA::FRI::IDLE) {
    }
    application.disconnect();
    return client.last_action;
}
