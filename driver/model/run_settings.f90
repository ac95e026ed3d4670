!> What a run is told to do. Defaults are those of the input file (docs/driver.md).
module run_settings
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use chain_settings, only : chain
    use initial_states, only : initial_values
    use law_facts, only : typical_strength
    use loading_programme, only : programme
    use slider_system, only : ends_fixed, normal_motion
    use unit_names, only : units
    implicit none
    private

    public :: next_row, settings

    type :: settings
        real(dp), allocatable :: props(:)   !! constants of the friction routine
        real(dp) :: mass = 0.0_dp           !! 0: quasi-static [F T^2/L]
        real(dp) :: stiffness = 0.0_dp      !! of the drive spring, > 0 [F/L]
        real(dp) :: damping = 0.0_dp        !! [F T/L]
        real(dp) :: area = 1.0_dp           !! apparent contact area [L^2]
        type(normal_motion) :: across       !! the interface; its place at rest follows
        type(initial_values) :: initial
        type(programme) :: drive
        type(chain) :: chain
        real(dp) :: t_end = 0.0_dp, dt = 0.0_dp   !! end of the run, step or first step, > 0 [T]
        real(dp) :: checkpoint = 60.0_dp    !! time between two checkpoints, by the clock [s]
        logical :: adaptive = .false.       !! the error chooses the steps
        logical :: newmark = .false.        !! and they are Newmark's, as those of chains are
        logical :: rigid_contact = .false.  !! no contact spring: its slip rate is the velocity
        real(dp) :: rtol = 0.0_dp           !! error in a step, part of the static friction force
        real(dp) :: dt_min = 0.0_dp, dt_max = 0.0_dp   !! of adaptive steps [T]
        integer :: order = 1                !! of the method with the friction law in it
        real(dp) :: beta = 0.25_dp, gamma = 0.5_dp   !! of Newmark's method
        real(dp) :: rho_infinity = -1.0_dp  !! of the generalised-alpha method; negative: not asked
        real(dp) :: tolerance = 1.0e-10_dp  !! of the force residual, relative to the largest force
        integer :: max_iterations = 25      !! of Newton's method in a step
        integer :: interval = 1             !! steps between two rows of the CSV file
        real(dp) :: every = 0.0_dp          !! time between two rows; 0: rows by `interval` [T]
        integer :: fields = 0               !! steps between two rows of a chain's fields; 0: none
        real(dp) :: event_drop = 1.0e-3_dp  !! of slip events: part of the static friction force
        real(dp) :: event_slip_rate = 0.0_dp   !! slip rate in them [L/T]; 0: by the drive's speed
        integer :: n_steps = 0              !! follows from t_end and dt
        real(dp) :: table_limit = 10.0_dp   !! that the tables may take on disk [GB]
        type(units) :: units                !! that the numbers are in, for pictures
        integer(int64) :: fingerprint = 0   !! another one for any input with other results
    contains
        procedure :: event_force, load_vanishes, load_varies, loading_sense, one_by_itself
    end type settings

contains

    !> The least fall of the drive spring's force that makes an event, of one block [F].
    pure real(dp) function event_force(self) result(force)
        class(settings), intent(in) :: self

        force = self%event_drop * self%area * typical_strength(self%props, &
            self%drive%largest_normal())
    end function event_force

    !> Does the normal traction fall to 0, other than at once?
    pure logical function load_vanishes(self) result(yes)
        class(settings), intent(in) :: self

        yes = minval(self%drive%normal) - self%drive%amplitude <= 0.0_dp .and. self%load_varies()
    end function load_vanishes

    !> Does the normal traction change, other than at once?
    pure logical function load_varies(self) result(yes)
        class(settings), intent(in) :: self

        yes = self%drive%amplitude > 0.0_dp .or. any(abs(self%drive%normal_rate) > 0.0_dp)
    end function load_varies

    !> Is there one block alone, which nothing but its drive spring holds?
    pure logical function one_by_itself(self) result(yes)
        class(settings), intent(in) :: self

        yes = self%chain%n_blocks == 1 .and. .not. (self%chain%ends == ends_fixed &
            .and. self%chain%coupling > 0.0_dp)
    end function one_by_itself

    !> 1 or -1: the sense in which the drive moves first; of one that never does, that in which its
    !> spring pulls at the start, or else the block moves.
    pure integer function loading_sense(self) result(sense)
        class(settings), intent(in) :: self
        real(dp) :: senses(3)
        integer :: i

        sense = 1
        senses = [self%drive%first_velocity(), self%initial%spring_force, self%initial%velocity]
        do i = size(senses), 1, -1
            if (senses(i) > 0.0_dp) sense = 1
            if (senses(i) < 0.0_dp) sense = -1
        end do
    end function loading_sense

    !> The first multiple of `every` after a time; huge if there is none [T].
    pure real(dp) function next_row(every, time) result(next)
        real(dp), intent(in) :: every, time   !! [T]
        real(dp) :: n

        next = huge(next)
        if (every <= 0.0_dp) return
        n = anint(time / every)
        if (every * n <= time) n = n + 1.0_dp
        next = every * n
    end function next_row

end module run_settings
