!> A block whose contact sticks swings between its drive spring and its contact spring, while these
!> are pulled at a constant velocity: `M u'' + C u' + (K + S alpha_t) u = K (s + V t)`, with u the
!> elastic displacement of the contact and s the extensions of both springs. In closed form, where
!> that is less than critically damped.
module free_swing
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : law_state, load_rates
    use slider_rates, only : controlled, damped, drive_work, elastic, extension, memory, &
        slider_equations, unknowns, velocity
    implicit none
    private

    public :: swing

    !> The constants of the motion.
    type :: swing
        real(dp) :: mass = 0.0_dp, stiffness = 0.0_dp, damping = 0.0_dp   !! as of `slider`
        real(dp) :: both = 0.0_dp        !! stiffness of both springs [F/L]
        real(dp) :: decay = 0.0_dp       !! of the amplitude [1/T]
        real(dp) :: frequency = 0.0_dp   !! angular; 0: the block does not swing [1/T]
        real(dp) :: healing = 0.0_dp     !! rate of what the law remembers [1/T]
    contains
        procedure :: prepare, amplitude, until_it_turns, go_on
    end type swing

contains

    subroutine prepare(self, eq)
        class(swing), intent(inout) :: self
        type(slider_equations), intent(in) :: eq
        real(dp), parameter :: near_critical = 0.9_dp
        type(law_state) :: some, more   !! rates
        real(dp) :: square

        self%mass = eq%mass
        self%stiffness = eq%stiffness
        self%damping = eq%damping
        self%both = eq%stiffness + eq%area * eq%alpha
        self%frequency = 0.0_dp
        self%healing = 0.0_dp
        if (.not. self%mass > 0.0_dp) return
        associate (rest => load_rates(0.0_dp, 0.0_dp, eq%alpha, 0.0_dp, 0.0_dp, .false.))
            some = eq%surface%state_rates(law_state(mu=0.0_dp, r=0.0_dp), rest, 0.0_dp)
            more = eq%surface%state_rates(law_state(mu=1.0_dp, r=0.0_dp), rest, 0.0_dp)
        end associate
        self%healing = some%mu - more%mu
        self%decay = 0.5_dp * self%damping / self%mass
        square = self%both / self%mass
        if (self%decay < near_critical * sqrt(square)) self%frequency = sqrt(square - self%decay**2)
    end subroutine prepare

    !> Of the elastic displacement about that in a steady motion, from the place and velocity there.
    pure function amplitude(self, y, v_drive) result(size)
        class(swing), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(in) :: v_drive   !! [L/T]
        real(dp) :: size                  !! [L]
        real(dp) :: mean(2), off(2)

        call split(self, y, v_drive, mean, off)
        size = hypot(off(1), off(2) / self%frequency)
    end function amplitude

    !> Parts of the elastic displacement and its velocity: those of a steady motion, and what swings
    !> about them.
    pure subroutine split(self, y, v_drive, mean, off)
        class(swing), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(in) :: v_drive   !! [L/T]
        real(dp), intent(out) :: mean(2), off(2)   !! [L], [L/T]

        mean(2) = self%stiffness * v_drive / self%both
        mean(1) = (self%stiffness * (y(extension) + y(elastic)) - self%damping * mean(2)) &
            / self%both
        off = [y(elastic), y(velocity)] - mean
    end subroutine split

    !> The time until the velocity is at its next maximum in a sense, if its rate is positive [T].
    pure function until_it_turns(self, y, v_drive, sense) result(t)
        class(swing), intent(in) :: self
        real(dp), intent(in) :: y(controlled)
        real(dp), intent(in) :: v_drive   !! [L/T]
        real(dp), intent(in) :: sense     !! 1 or -1
        real(dp) :: t
        real(dp) :: mean(2), off(2), rate, bend

        t = huge(t)
        call split(self, y, v_drive, mean, off)
        rate = -sense * (2.0_dp * self%decay * off(2) + self%both / self%mass * off(1))
        if (rate <= 0.0_dp) return
        bend = -sense * self%both / self%mass * off(2) - self%decay * rate
        t = atan2(rate, -bend / self%frequency) / self%frequency
    end function until_it_turns

    !> From `y` by `h`. The losses follow from the energy of what swings, which nothing else takes.
    pure subroutine go_on(self, h, y, v_drive, healing, new)
        class(swing), intent(in) :: self
        real(dp), intent(in) :: h         !! [T]
        real(dp), intent(in) :: y(unknowns)
        real(dp), intent(in) :: v_drive   !! [L/T]
        real(dp), intent(in) :: healing   !! rate of what the law remembers at the start
        real(dp), intent(out) :: new(unknowns)
        real(dp) :: mean(2), off(2), later(2), left, along, across, way, moved

        call split(self, y(:controlled), v_drive, mean, off)
        left = exp(-self%decay * h)
        along = left * cos(self%frequency * h)
        across = left * sin(self%frequency * h) / self%frequency
        later(1) = along * off(1) + across * (off(2) + self%decay * off(1))
        later(2) = along * off(2) - across * (self%both / self%mass * off(1) + self%decay * off(2))
        new = y
        moved = (later(1) - off(1)) + mean(2) * h
        new(elastic) = y(elastic) + moved
        new(velocity) = mean(2) + later(2)
        new(extension) = y(extension) + (v_drive * h - moved)
        if (self%healing > 0.0_dp) new(memory) = y(memory) + healing * (1.0_dp - exp(-self%healing &
            * h)) / self%healing
        ! the time integral of the elastic displacement beyond its start
        way = 0.5_dp * mean(2) * h**2 - off(1) * h - (self%mass * (later(2) - off(2)) &
            + self%damping * (later(1) - off(1))) / self%both
        new(drive_work) = y(drive_work) + self%stiffness * v_drive * ((y(extension) + 0.5_dp &
            * v_drive * h) * h - way)
        if (.not. self%damping > 0.0_dp) return
        new(damped) = y(damped) + self%damping * mean(2) * (mean(2) * h + 2.0_dp * (later(1) &
            - off(1))) + 0.5_dp * (self%mass * (off(2)**2 - later(2)**2) + self%both &
            * (off(1)**2 - later(1)**2))
    end subroutine go_on

end module free_swing
