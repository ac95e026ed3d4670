!> One step of the exponential trapezoidal rule, for one block with a mass. What oscillates on the
!> drive spring and on the contact, as long as that stays linear, is followed exactly, however fast
!> it is; what the contact's force departs from linear is taken to vary linearly over the step:
!>
!>     M x'' + C x' + (K + k) x = K x_d - (S f_t - k x),   k: about S df_t/dx
!>
!> Second order for any k. The rule is symmetric in time: with k unchanged its error has even powers
!> of the step alone, as far as friction is smooth.
module exponential_rule
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use abstract_integrator, only : step_report
    use driven_oscillator, only : oscillator, responses
    use friction_mod, only : friction_no_convergence
    use slider_system, only : friction_forces, slider, slider_state
    implicit none
    private

    public :: exponential

    type :: exponential
        real(dp) :: tolerance = 1.0e-10_dp   !! of the residual, relative to the largest force
        real(dp) :: negligible = 0.0_dp      !! error of a displacement that does not matter [L]
        integer :: max_iterations = 25
        real(dp) :: contact = 0.0_dp         !! k, the contact's part of the linear spring [F/L]
    contains
        procedure :: step
    end type exponential

    !> The equation q = known + weight (pull - S f_t(q) + k q) of the displacement q in a step.
    type :: equation
        type(oscillator) :: response
        real(dp) :: start          !! force on the block at the start, without damping [F]
        real(dp) :: pull           !! of the drive spring at the end, at q = 0 [F]
        real(dp) :: known          !! [L]
        real(dp) :: weight         !! [L/F]
    end type equation

contains

    !> Moves `old` by `dt` to `new`, under the drive position and normal traction at the end.
    subroutine step(self, system, drive, normal, dt, old, new, report, fit, guess)
        class(exponential), intent(inout) :: self
        type(slider), intent(in) :: system       !! one block, with a mass
        real(dp), intent(in) :: drive            !! position of the drive at the end [L]
        real(dp), intent(in) :: normal           !! normal traction at the end [F/L^2]
        real(dp), intent(in) :: dt               !! > 0 [T]
        type(slider_state), intent(in) :: old
        type(slider_state), intent(inout) :: new   !! allocated like `old`
        type(step_report), intent(out) :: report
        logical, intent(in) :: fit     !! take for k what the contact shows in this step
        real(dp), intent(in), optional :: guess(:)   !! of the displacement at the end [L]
        type(equation) :: balance
        real(dp) :: q(1), tangent(1), residual, scale

        report%iterations = 0
        new%time = old%time + dt
        new%drive = drive
        new%normal = normal
        balance = balance_of_step(self%contact, system, drive, dt, old)
        q(1) = linear_guess()
        if (present(guess)) q = guess - old%x
        call evaluate()
        if (report%status < 0) return
        if (fit .and. differs(tangent(1))) then
            self%contact = max(0.0_dp, tangent(1))
            balance = balance_of_step(self%contact, system, drive, dt, old)
            q(1) = linear_guess()
            call evaluate()
            if (report%status < 0) return
        end if
        call find_balance()
        if (report%status < 0) return
        report%stiffness = system%stiffness + tangent(1)
        call finish_step()

    contains

        !> What follows from the displacement. Damping is what the work of the forces leaves over.
        subroutine finish_step()
            real(dp) :: rise, mean   ! of the force over the step, and the mean displacement

            associate (b => balance, o => balance%response)
                rise = b%pull - new%friction(1) + self%contact * q(1) - b%start
                new%v(1) = old%v(1) * o%ds + (dt / system%mass) * (o%s * b%start + o%i0 * rise)
                mean = dt * old%v(1) * o%i0 + (dt**2 / system%mass) * (o%i1 * b%start + o%i2 &
                    * rise)
                new%damped = old%damped
                if (system%damping > 0.0_dp) new%damped = old%damped + (b%start + rise) * q(1) &
                    - rise * mean - 0.5_dp * (system%mass * (new%v(1)**2 - old%v(1)**2) &
                    + (system%stiffness + self%contact) * q(1)**2)
            end associate
            new%drive_work = old%drive_work + system%stiffness * (drive - old%drive) * (0.5_dp &
                * (drive + old%drive) - old%x(1) - mean)
            new%a(1) = (new%spring(1) - system%damping * new%v(1) - new%friction(1)) / system%mass
        end subroutine finish_step

        !> Would k = `stiffness` change the step?
        pure function differs(stiffness) result(yes)
            real(dp), intent(in) :: stiffness
            logical :: yes
            real(dp), parameter :: close_enough = 0.01_dp

            yes = abs(stiffness - self%contact) > close_enough * (system%stiffness + self%contact)
        end function differs

        !> The displacement if the contact is a linear spring.
        pure function linear_guess() result(displacement)
            real(dp) :: displacement

            displacement = balance%known + balance%weight * (balance%pull - old%friction(1))
        end function linear_guess

        !> Forces at the displacement q, and what is out of balance.
        subroutine evaluate()
            new%x(1) = old%x(1) + q(1)
            new%spring(1) = system%stiffness * (drive - new%x(1))
            call friction_forces(system, old%statev, normal, q, dt, new%statev, new%friction, &
                tangent, report%status)
            residual = (balance%known - q(1)) / balance%weight + balance%pull - new%friction(1) &
                + self%contact * q(1)
            ! what inertia takes to go so far is known to round-off only
            scale = max(abs(new%spring(1)) + abs(new%friction(1)), 8.0_dp * epsilon(q) * abs(q(1)) &
                / (balance%weight * self%tolerance))
        end subroutine evaluate

        !> Newton's method; a step is halved as long as it leads away.
        subroutine find_balance()
            integer, parameter :: max_halvings = 8
            real(dp) :: slope, correction, before, q_before
            integer :: halving

            do
                if (abs(residual) <= max(self%tolerance * scale, self%negligible &
                    / balance%weight)) return
                slope = 1.0_dp / balance%weight + tangent(1) - self%contact
                if (report%iterations == self%max_iterations .or. slope <= 0.0_dp) then
                    report%status = friction_no_convergence
                    return
                end if
                report%iterations = report%iterations + 1
                correction = residual / slope
                if (abs(correction) <= epsilon(q) * abs(new%x(1))) return
                before = residual
                q_before = q(1)
                do halving = 0, max_halvings
                    q(1) = q_before + correction / 2**halving
                    call evaluate()
                    if (report%status < 0) return
                    if (abs(residual) < abs(before)) exit
                end do
            end do
        end subroutine find_balance

    end subroutine step

    pure function balance_of_step(contact, system, drive, dt, old) result(b)
        real(dp), intent(in) :: contact   !! k [F/L]
        type(slider), intent(in) :: system
        real(dp), intent(in) :: drive, dt
        type(slider_state), intent(in) :: old
        type(equation) :: b
        real(dp) :: mobility

        b%response = responses(system%mass, system%damping, system%stiffness + contact, dt)
        b%start = old%spring(1) - old%friction(1)
        b%pull = system%stiffness * (drive - old%x(1))
        mobility = dt**2 / system%mass
        b%weight = mobility * b%response%i1
        b%known = dt * old%v(1) * b%response%s + mobility * (b%response%i0 - b%response%i1) &
            * b%start
    end function balance_of_step

end module exponential_rule
