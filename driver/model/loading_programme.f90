!> Loading over time: motion of the drive and normal traction, as pieces within which the velocity
!> and the traction are linear, with an oscillation on the traction.
module loading_programme
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use grid_map, only : nodes_up_to
    implicit none
    private

    public :: programme

    !> Piece i holds from start(i) on; the last one goes on for ever.
    type :: programme
        real(dp), allocatable :: start(:)          !! times, the first is 0 [T]
        real(dp), allocatable :: travel(:)         !! of the drive up to each start [L]
        real(dp), allocatable :: velocity(:)       !! of the drive at each start [L/T]
        real(dp), allocatable :: acceleration(:)   !! of the drive [L/T^2]
        real(dp), allocatable :: normal(:)         !! normal traction at each start [F/L^2]
        real(dp), allocatable :: normal_rate(:)    !! [F/L^2/T]
        real(dp) :: amplitude = 0.0_dp             !! of the oscillating normal traction [F/L^2]
        real(dp) :: frequency = 0.0_dp             !! [1/T]
        real(dp) :: phase = 0.0_dp                 !! at time 0 [rad]
        real(dp) :: measured_until = huge(1.0_dp)  !! end of the file that it is from [T]
        integer :: listed = 1                      !! pieces that the summary tells apart
    contains
        procedure :: piece, position, drive_velocity, normal_traction, largest_normal, next_start
        procedure :: first_velocity, divide, add_up_travel
    end type programme

contains

    !> Which piece holds at time `t`?
    pure integer function piece(self, t) result(i)
        class(programme), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]

        i = 1
        if (size(self%start) > 1) i = max(1, nodes_up_to(self%start, t))
    end function piece

    !> How far the drive has moved by time `t` [L].
    pure real(dp) function position(self, t) result(x)
        class(programme), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        real(dp) :: since
        integer :: i

        i = self%piece(t)
        since = t - self%start(i)
        x = self%travel(i) + since * (self%velocity(i) + 0.5_dp * self%acceleration(i) * since)
    end function position

    !> Velocity of the drive at time `t`, as piece `i` has it: at the end of that piece or inside
    !> it [L/T].
    pure real(dp) function drive_velocity(self, t, i) result(v)
        class(programme), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        integer, intent(in) :: i

        v = self%velocity(i) + self%acceleration(i) * (t - self%start(i))
    end function drive_velocity

    !> Normal traction at time `t`, as piece `i` has it: at the end of that piece or inside it.
    pure function normal_traction(self, t, i) result(p)
        class(programme), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        integer, intent(in) :: i
        real(dp) :: p               !! below 0: the contact is open [F/L^2]
        real(dp), parameter :: two_pi = 8.0_dp * atan(1.0_dp)

        p = self%normal(i) + self%normal_rate(i) * (t - self%start(i))
        if (self%amplitude > 0.0_dp) p = p &
            + self%amplitude * sin(two_pi * self%frequency * t + self%phase)
    end function normal_traction

    !> The largest normal traction of all pieces [F/L^2].
    pure real(dp) function largest_normal(self) result(p)
        class(programme), intent(in) :: self

        p = maxval(self%normal) + self%amplitude
    end function largest_normal

    !> Mean velocity in the first piece in which the drive moves; 0 if it never does [L/T].
    pure real(dp) function first_velocity(self) result(v)
        class(programme), intent(in) :: self
        integer :: i

        v = 0.0_dp
        do i = 1, size(self%start)
            v = self%velocity(i)
            if (i < size(self%start)) v = v + 0.5_dp * self%acceleration(i) &
                * (self%start(i + 1) - self%start(i))
            if (abs(v) > 0.0_dp) return
        end do
    end function first_velocity

    !> When the piece that holds at time `t` ends; never, for the last one [T].
    pure real(dp) function next_start(self, t) result(t_next)
        class(programme), intent(in) :: self
        real(dp), intent(in) :: t   !! [T]
        integer :: i

        i = self%piece(t)
        t_next = huge(t_next)
        if (i < size(self%start)) t_next = self%start(i + 1)
    end function next_start

    !> Starts a new piece at time `t` that goes on as before, so that events are booked by
    !> themselves from there on.
    pure subroutine divide(self, t)
        class(programme), intent(inout) :: self
        real(dp), intent(in) :: t   !! > 0 [T]
        real(dp) :: since, travel
        integer :: i

        i = self%piece(t)
        since = t - self%start(i)
        if (since > 0.0_dp) then
            travel = self%position(t)
            self%start = [self%start(:i), t, self%start(i + 1:)]
            self%travel = [self%travel(:i), travel, self%travel(i + 1:)]
            self%velocity = [self%velocity(:i), self%velocity(i) + self%acceleration(i) * since, &
                self%velocity(i + 1:)]
            self%acceleration = [self%acceleration(:i), self%acceleration(i:)]
            self%normal = [self%normal(:i), self%normal(i) + self%normal_rate(i) * since, &
                self%normal(i + 1:)]
            self%normal_rate = [self%normal_rate(:i), self%normal_rate(i:)]
        end if
        self%listed = size(self%start)
    end subroutine divide

    !> Fills `travel` from the starts, velocities and accelerations of the pieces.
    pure subroutine add_up_travel(self)
        class(programme), intent(inout) :: self
        real(dp) :: width
        integer :: i

        self%travel = 0.0_dp * self%velocity
        do i = 2, size(self%start)
            width = self%start(i) - self%start(i - 1)
            self%travel(i) = self%travel(i - 1) + width * (self%velocity(i - 1) &
                + 0.5_dp * self%acceleration(i - 1) * width)
        end do
    end subroutine add_up_travel

end module loading_programme
