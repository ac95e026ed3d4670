!> Orthonormal axes of a contact, made from its normal.
module friction_axes
    use friction_kinds, only : wp
    use friction_status, only : friction_bad_axis, friction_ok
    implicit none
    private

    public :: contact_axes, is_unit_vector, turn_axes

contains

    !> Is a normal of unit length? One in single precision still passes.
    pure function is_unit_vector(normal) result(unit)
        real(wp), intent(in), contiguous :: normal(:)   !! finite [-]
        logical :: unit
        real(wp), parameter :: unit_tolerance = 1.0e-6_wp   !! of the square of its length

        unit = abs(dot_product(normal, normal) - 1.0_wp) <= unit_tolerance
    end function is_unit_vector

    !> Orthonormal axes that start with the normal, as columns; tangential ones are as good as any.
    !> Without a division by a small number for every normal (Duff et al., J. Comput. Graph. Tech.
    !> 6(1), 2017).
    pure function contact_axes(normal) result(axes)
        real(wp), intent(in), contiguous :: normal(:)   !! size 2 or 3
        real(wp) :: axes(3, 3)
        real(wp) :: n(3), sign_z, a, b

        n = 0.0_wp
        n(1:size(normal)) = normal / norm2(normal)
        axes = 0.0_wp
        axes(:, 1) = n
        if (size(normal) == 2) then
            axes(1:2, 2) = [-n(2), n(1)]
        else
            sign_z = sign(1.0_wp, n(3))
            a = -1.0_wp / (sign_z + n(3))
            b = n(1) * n(2) * a
            axes(:, 2) = [1.0_wp + sign_z * n(1)**2 * a, sign_z * b, -sign_z * n(1)]
            axes(:, 3) = [b, sign_z + n(2)**2 * a, -n(2)]
        end if
    end function contact_axes

    !> Turns the tangential axes in their plane, so that the first is along `axis`.
    pure subroutine turn_axes(axis, axes, status)
        real(wp), intent(in) :: axis(3)         !! of any length, finite
        real(wp), intent(inout) :: axes(3, 3)   !! as columns, the first is the normal
        integer, intent(out) :: status          !! ok or bad axis
        real(wp), parameter :: least = 1.0e-6_wp   !! sine of its angle to the normal
        real(wp) :: along(3), part(2), old(3, 2)

        status = friction_bad_axis
        old = axes(:, 2:3)
        ! not so short that squares underflow; by a power of two, which changes no digit
        along = scale(axis, -exponent(max(abs(axis(1)), abs(axis(2)), abs(axis(3)))))
        part(1) = dot_product(along, old(:, 1))
        part(2) = dot_product(along, old(:, 2))
        if (.not. norm2(part) > least * norm2(along)) return
        part = part / norm2(part)
        axes(:, 2) = part(1) * old(:, 1) + part(2) * old(:, 2)
        axes(:, 3) = part(1) * old(:, 2) - part(2) * old(:, 1)
        status = friction_ok
    end subroutine turn_axes

end module friction_axes
