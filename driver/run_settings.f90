!> What a run is told to do: the groups and keys of the input file, with their defaults and rules.
module run_settings
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use law_input, only : read_friction
    use namelist_input, only : above, any_number, at_least, between, namelist_file, rule
    implicit none
    private

    public :: programme, read_settings, settings

    !> Drive velocity and normal traction over time, piecewise constant; the last piece goes on.
    type :: programme
        real(dp), allocatable :: start(:)      !! times at which the pieces start [T]
        real(dp), allocatable :: velocity(:)   !! of the drive [L/T]
        real(dp), allocatable :: normal(:)     !! normal traction [F/L^2]
    contains
        procedure :: piece
        procedure :: position
    end type programme

    type :: settings
        real(dp), allocatable :: props(:)   !! constants of the friction routine
        real(dp) :: mass                    !! [M]
        real(dp) :: stiffness               !! of the drive spring [F/L]
        real(dp) :: damping                 !! [F T/L]
        real(dp) :: area                    !! apparent contact area [L^2]
        type(programme) :: drive
        real(dp) :: t_end, dt               !! end of the run, step [T]
        real(dp) :: beta, gamma             !! of Newmark's method
        real(dp) :: tolerance               !! of the force residual, relative to the largest force
        integer :: max_iterations           !! of Newton's method in a step
        integer :: interval                 !! steps between two rows of the CSV file
        integer :: n_steps                  !! follows from t_end and dt
    end type settings

contains

    !> Which piece holds at time `t`?
    pure function piece(self, t) result(i)
        class(programme), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        integer :: i

        i = max(1, count(self%start <= t))
    end function piece

    !> How far the drive has moved by time `t`.
    pure function position(self, t) result(x)
        class(programme), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        real(dp) :: x               !! [L]
        integer :: i

        x = 0.0_dp
        do i = 2, self%piece(t)
            x = x + self%velocity(i - 1) * (self%start(i) - self%start(i - 1))
        end do
        i = self%piece(t)
        x = x + self%velocity(i) * (t - self%start(i))
    end function position

    !> Takes the settings from a file; every fault is left in `file%faults`.
    subroutine read_settings(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(out) :: run
        character(len=8), parameter :: needed(4) = ['friction', 'slider  ', 'drive   ', 'time    ']
        real(dp) :: normal
        integer :: i

        do i = 1, size(needed)
            if (.not. file%has_group(trim(needed(i)))) then
                call file%add_fault(0, 'group &' // trim(needed(i)) // ' is missing')
            end if
        end do
        call read_friction(file, run%props)
        call file%get_real('slider', 'mass', run%mass, above(0.0_dp))
        call file%get_real('slider', 'stiffness', run%stiffness, above(0.0_dp))
        call file%get_real('slider', 'damping', run%damping, at_least(0.0_dp), default=0.0_dp)
        call file%get_real('slider', 'area', run%area, above(0.0_dp), default=1.0_dp)
        if (file%given('drive', 'normal')) then
            call file%get_real('slider', 'normal_traction', normal, at_least(0.0_dp), &
                default=0.0_dp)
        else
            call file%get_real('slider', 'normal_traction', normal, above(0.0_dp))
        end if
        call read_drive(file, normal, run%drive)
        call read_time(file, run)
        if (file%has_group('output')) continue
        call file%get_integer('output', 'interval', run%interval, at_least(1.0_dp), default=1)
        call file%refuse_unknown()
    end subroutine read_settings

    !> Velocity and normal traction over time. One value stands for all pieces.
    subroutine read_drive(file, normal_traction, drive)
        type(namelist_file), intent(inout) :: file
        real(dp), intent(in) :: normal_traction   !! where &drive gives none [F/L^2]
        type(programme), intent(out) :: drive
        character(len=*), parameter :: group = 'drive'
        real(dp), allocatable :: velocity(:), normal(:), duration(:)
        integer :: faults_before, n, i

        faults_before = size(file%faults)
        call file%require(group, 'velocity')
        call file%get_reals(group, 'velocity', velocity, any_number())
        call file%get_reals(group, 'duration', duration, above(0.0_dp))
        call file%get_reals(group, 'normal', normal, at_least(0.0_dp))
        if (size(file%faults) > faults_before .or. size(velocity) == 0) return
        if (size(normal) == 0) normal = [normal_traction]
        n = max(size(velocity), size(normal), size(duration))
        call check_length('velocity', size(velocity))
        call check_length('normal', size(normal))
        if (size(duration) /= n .and. n > 1) then
            call file%reject(group, 'duration', 'must have ' // counted(n) &
                // ', one for each piece')
        end if
        if (size(file%faults) > faults_before) return

        if (size(velocity) < n) velocity = [(velocity(1), i = 1, n)]
        if (size(normal) < n) normal = [(normal(1), i = 1, n)]
        drive%velocity = velocity
        drive%normal = normal
        drive%start = [0.0_dp, (sum(duration(:i)), i = 1, n - 1)]

    contains

        subroutine check_length(key, length)
            character(len=*), intent(in) :: key
            integer, intent(in) :: length

            if (length == n .or. (length == 1 .and. size(duration) == n)) return
            call file%reject(group, key, 'must have one value or ' // counted(n) &
                // ', as many as the other lists')
        end subroutine check_length

    end subroutine read_drive

    subroutine read_time(file, run)
        type(namelist_file), intent(inout) :: file
        type(settings), intent(inout) :: run
        character(len=*), parameter :: group = 'time'
        real(dp) :: steps
        integer :: faults_before

        faults_before = size(file%faults)
        call file%get_real(group, 't_end', run%t_end, above(0.0_dp))
        call file%get_real(group, 'dt', run%dt, above(0.0_dp))
        call file%get_real(group, 'beta', run%beta, between(0.01_dp, 1.0_dp), default=0.25_dp)
        call file%get_real(group, 'gamma', run%gamma, between(0.5_dp, 1.0_dp), default=0.5_dp)
        call file%get_real(group, 'tolerance', run%tolerance, above(0.0_dp), default=1.0e-10_dp)
        call file%get_integer(group, 'max_iterations', run%max_iterations, &
            between(1.0_dp, 1.0e6_dp), default=25)
        run%n_steps = 0
        if (size(file%faults) > faults_before .or. .not. run%dt > 0.0_dp) return
        if (run%dt > run%t_end) call file%reject(group, 'dt', 'must not exceed t_end')
        if (run%t_end > run%dt * real(huge(run%n_steps) - 1, dp)) then
            call file%reject(group, 'dt', 'makes more steps up to t_end than can be counted')
        end if
        if (size(file%faults) > faults_before) return
        steps = run%t_end / run%dt
        run%n_steps = nint(steps)
        if (abs(steps - run%n_steps) > 1.0e-9_dp * steps) run%n_steps = ceiling(steps)   ! last is
                                                                                         ! short
    end subroutine read_time

    pure function counted(n) result(text)
        integer, intent(in) :: n
        character(len=:), allocatable :: text
        character(len=20) :: buffer

        write (buffer, '(i0, a)') n, ' value'
        text = trim(buffer)
        if (n /= 1) text = text // 's'
    end function counted

end module run_settings
