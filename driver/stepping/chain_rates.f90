!> A chain of blocks in continuous time, under laws without a yield point: the rate equations of
!> each block, and the springs between neighbours.
module chain_rates
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use loading_programme, only : programme
    use slider_rates, only : controlled, extension, slider_equations, velocity
    use slider_system, only : ends_fixed, ends_free, slider
    implicit none
    private

    public :: chain_equations

    type :: chain_equations
        type(slider_equations), allocatable :: blocks(:)   !! one, if all blocks are alike; the
                                                           !! drive of each is the piece alone
        type(slider) :: system
        type(programme) :: drive
        real(dp) :: origin = 0.0_dp   !! of the drive: its position at time 0 [L]
        integer :: piece = 0          !! of the programme, in which the rates are taken
    contains
        procedure :: enter, rates, by_own_extension, by_walls
    end type chain_equations

contains

    !> Takes the equations to a piece of the programme.
    subroutine enter(self, piece)
        class(chain_equations), intent(inout) :: self
        integer, intent(in) :: piece
        real(dp) :: load   !! of a block
        integer :: i

        self%piece = piece
        load = 1.0_dp
        do i = 1, size(self%blocks)
            if (allocated(self%system%load)) load = self%system%load(i)
            associate (own => self%blocks(i)%drive, all => self%drive)
                own%start = [all%start(piece)]
                own%velocity = [all%velocity(piece)]
                own%acceleration = [all%acceleration(piece)]
                own%normal = [load * all%normal(piece)]
                own%normal_rate = [load * all%normal_rate(piece)]
                own%amplitude = load * all%amplitude
                own%frequency = all%frequency
                own%phase = all%phase
            end associate
            call self%blocks(i)%enter(1)
        end do
    end subroutine enter

    !> Rates of the unknowns.
    subroutine rates(self, t, y, dy, failed)
        class(chain_equations), intent(in) :: self
        real(dp), intent(in) :: t               !! [T]
        real(dp), intent(in) :: y(:, :)         !! one column a block
        real(dp), intent(inout) :: dy(:, :)
        logical, intent(out) :: failed          !! slip of a block has no rate
        real(dp), dimension(size(y, 2)) :: x, force
        integer :: i

        do i = 1, size(y, 2)
            call self%blocks(min(i, size(self%blocks)))%rates(t, y(:controlled, i), dy(:, i), &
                failed)
            if (failed) return
        end do
        x = self%origin + self%drive%position(t) - y(extension, :)
        force = 0.0_dp
        call self%system%add_coupling(x, 1.0_dp, force)
        dy(velocity, :) = dy(velocity, :) + force / self%system%mass
    end subroutine rates

    !> Derivative of a block's acceleration by the extension of its drive spring, for the springs to
    !> its neighbours [1/T^2].
    pure function by_own_extension(self, i, n) result(derivative)
        class(chain_equations), intent(in) :: self
        integer, intent(in) :: i, n   !! block, blocks
        real(dp) :: derivative
        integer :: springs

        springs = 2
        if (self%system%ends == ends_free .and. i == 1) springs = springs - 1
        if (self%system%ends == ends_free .and. i == n) springs = springs - 1
        derivative = springs * self%system%coupling / self%system%mass
    end function by_own_extension

    !> Derivative of a block's acceleration by time: the drive leaves the walls behind [L/T^3].
    pure function by_walls(self, i, n, t) result(derivative)
        class(chain_equations), intent(in) :: self
        integer, intent(in) :: i, n   !! block, blocks
        real(dp), intent(in) :: t     !! [T]
        real(dp) :: derivative
        integer :: walls

        walls = 0
        if (self%system%ends == ends_fixed) walls = count([i == 1, i == n])
        derivative = -walls * self%system%coupling / self%system%mass &
            * self%drive%drive_velocity(t, self%piece)
    end function by_walls

end module chain_rates
