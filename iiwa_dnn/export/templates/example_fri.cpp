// A client of KUKA's Fast Robot Interface that moves the arm by the controller, in position control.
// It needs the FRI client SDK; the FRI's sample time has to be CONTROLLER_DT.
#include "controller.h"
#include "friLBRClient.h"

class ControllerClient : public KUKA::FRI::LBRClient {
public:
    ControllerClient() { controller_init(&controller_); }

    // Called by the FRI at every sample while the robot may be commanded.
    void command() override
    {
        const double *measured = robotState().getMeasuredJointPosition();
        if (!started_) {
            for (int i = 0; i < CONTROLLER_DOF; i++) {
                q_[i] = measured[i];
            }
            started_ = true;
        }
        double dq[CONTROLLER_DOF];
@fri_sample@        last_action = controller_step(&controller_, q_, target, dq);
        for (int i = 0; i < CONTROLLER_DOF; i++) {
            q_[i] += CONTROLLER_DT * dq[i];  // what was commanded, free of the encoders' noise
        }
        robotCommand().setJointPosition(q_);
        t_ += CONTROLLER_DT;
    }

    // 18 numbers a frame: position, rotation row by row, linear and angular velocity.
    double target[18 * CONTROLLER_FRAMES] = {@target@};
    int last_action = 0;

private:
    struct controller controller_;
    double q_[CONTROLLER_DOF] = {0.0};
    double t_ = 0.0;
    bool started_ = false;
};
